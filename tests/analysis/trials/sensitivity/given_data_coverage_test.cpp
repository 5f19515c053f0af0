// How often bounds of first-order indices from any sample cover the index, by simulation with fixed seeds: of
// factors that are smooth, skewed, discrete or of a few values, on outputs that are additive, interacting,
// saturated, a step, heavy-tailed or a yes or no. All indices are known in closed form.
#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/trials/sensitivity/sobol_indices.hpp"
#include "tests/analysis/trials/sensitivity/test_functions.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sensitivity {
namespace {

/// Random numbers of one sample.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}

  double uniform() { return std::uniform_real_distribution(0.0, 1.0)(random_); }
  double normal() { return std::normal_distribution()(random_); }
  double exponential() { return std::exponential_distribution()(random_); }
  double student(double degrees) { return std::student_t_distribution(degrees)(random_); }
  /// A lognormal number with the median 1.
  double lognormal(double cv) { return std::exp(std::sqrt(std::log1p(cv * cv)) * normal()); }

 private:
  std::mt19937_64 random_;
};

double lognormal_mean(double cv) {
  return std::sqrt(1.0 + cv * cv);
}
double lognormal_variance(double cv) {
  return (1.0 + cv * cv) * cv * cv;
}

struct FactorAndOutput {
  double x;
  double y;
};

struct KnownIndex {
  std::string name;
  double index;
  std::function<FactorAndOutput(Draws&)> trial;
  /// The distribution is skewed, so with few trials the estimate may give no bounds of the index.
  bool skewed{false};
};

/// A linear output x·slope plus a uniform number, with the slope for which the factor x has the Sobol' index
/// `index`.
/// @param variance variance of x
KnownIndex linear(std::string name, double index, double variance, const std::function<double(Draws&)>& x) {
  const double slope = std::sqrt(index / (1.0 - index) / 12.0 / variance);
  return {std::move(name), index, [=](Draws& draws) {
            const double value = x(draws);
            return FactorAndOutput{value, slope * value + draws.uniform()};
          }};
}

std::vector<KnownIndex> linear_cases() {
  std::vector<KnownIndex> cases;
  for (const double index : {0.0, 0.05, 0.5, 0.95}) {
    cases.push_back(
        linear(fmt::format("uniform, {}", index), index, 1.0 / 12.0, [](Draws& d) { return d.uniform(); }));
    cases.push_back(
        linear(fmt::format("normal, {}", index), index, 1.0, [](Draws& d) { return d.normal(); }));
    cases.push_back(linear(fmt::format("a choice of two, {}", index), index, 0.25,
                           [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : 1.0; }));
    cases.push_back(linear(fmt::format("a rare choice, {}", index), index, 0.09,
                           [](Draws& d) { return d.uniform() < 0.1 ? 1.0 : 0.0; }));
    cases.push_back(linear(fmt::format("61 whole numbers, {}", index), index, 310.0,
                           [](Draws& d) { return std::floor(61.0 * d.uniform()); }));
  }
  return cases;
}

std::vector<KnownIndex> skewed_cases() {
  std::vector<KnownIndex> cases;
  for (const double cv : {0.5, 1.0, 2.0}) {
    const double v = lognormal_variance(cv);
    const double m = lognormal_mean(cv);
    const bool skewed = cv > 0.5;
    cases.push_back({fmt::format("lognormal {}", cv), v / (v + 0.75 + 0.1875),
                     [cv](Draws& d) {
                       const double x = d.lognormal(cv);
                       return FactorAndOutput{x, x + 3.0 * d.uniform() + 1.5 * d.uniform()};
                     },
                     skewed});
    cases.push_back({fmt::format("lognormal {} times uniform", cv),
                     0.25 * v / ((v + m * m) / 3.0 - 0.25 * m * m),
                     [cv](Draws& d) {
                       const double x = d.lognormal(cv);
                       return FactorAndOutput{x, x * d.uniform()};
                     },
                     true});
    cases.push_back({fmt::format("none, beside lognormal {}", cv), 0.0,
                     [cv](Draws& d) {
                       return FactorAndOutput{d.uniform(), d.lognormal(cv) + d.uniform()};
                     },
                     skewed});
    const double slope = std::sqrt(12.0 * v * 0.05 / 0.95);
    cases.push_back({fmt::format("0.05, beside lognormal {}", cv), 0.05,
                     [cv, slope](Draws& d) {
                       const double x = d.uniform();
                       return FactorAndOutput{x, d.lognormal(cv) + slope * x};
                     },
                     skewed});
  }
  cases.push_back({"exponential", 12.0 / 13.0,
                   [](Draws& d) {
                     const double x = d.exponential();
                     return FactorAndOutput{x, x + d.uniform()};
                   },
                   true});
  cases.push_back({"square of a normal", 24.0 / 25.0,
                   [](Draws& d) {
                     const double x = d.normal();
                     return FactorAndOutput{x, x * x + d.uniform()};
                   },
                   true});
  cases.push_back({"normal, beside Student's t of 5 degrees", 0.375, [](Draws& d) {
                     const double x = d.normal();
                     return FactorAndOutput{x, x + d.student(5.0)};
                   }});
  return cases;
}

std::vector<KnownIndex> bent_cases() {
  std::vector<KnownIndex> cases;
  // P(yes) = x²: the mean has the variance 1/5 − 1/9, all 2/9; of x⁹ 1/19 − 1/100 and 9/100.
  for (const auto& [power, index] : {std::pair(2.0, 0.4), std::pair(9.0, (1.0 / 19.0 - 0.01) / 0.09)}) {
    cases.push_back({fmt::format("yes with x to the power of {}", power), index, [power](Draws& d) {
                       const double x = d.uniform();
                       return FactorAndOutput{x, d.uniform() < std::pow(x, power) ? 1.0 : 0.0};
                     }});
  }
  const double above = statistics::normal_upper_tail(std::log(3.0) / std::sqrt(std::log1p(4.0)));
  const double step = above * (1.0 - above);
  cases.push_back({"step of lognormal 2", step / (step + 1.0 / 12.0), [](Draws& d) {
                     const double x = d.lognormal(2.0);
                     return FactorAndOutput{x, (x > 3.0 ? 1.0 : 0.0) + d.uniform()};
                   }});
  for (std::size_t j = 0; j < 3; ++j) {
    const auto at = [j](const testing::UnitFunction& function, std::size_t factors) {
      return [j, function, factors](Draws& d) {
        std::vector<double> u(factors);
        for (double& one : u) one = d.uniform();
        return FactorAndOutput{u[j], function(u)};
      };
    };
    cases.push_back(
        {fmt::format("Ishigami's {}", j + 1), testing::ishigami_first_orders()[j], at(testing::ishigami, 3)});
    cases.push_back(
        {fmt::format("g function's {}", j + 1), testing::g_first_orders(4)[j], at(testing::g_function, 4)});
  }
  return cases;
}

std::vector<KnownIndex> known_indices() {
  std::vector<KnownIndex> all = linear_cases();
  for (const auto& cases : {skewed_cases(), bent_cases()}) all.insert(all.end(), cases.begin(), cases.end());
  return all;
}

struct BoundsOfSamples {
  double covered{0.0};  ///< proportion of samples whose bounds hold the index
  double found{0.0};    ///< proportion of samples whose lower bound is above 1 % of the variance
  double width{0.0};    ///< mean width of the bounds
};

BoundsOfSamples bounds_of_samples(const KnownIndex& known, std::size_t trials, std::uint64_t samples) {
  BoundsOfSamples coverage;
  std::vector<double> x(trials);
  std::vector<double> y(trials);
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    Draws draws(1000 * trials + sample);
    for (std::size_t i = 0; i < trials; ++i) {
      const FactorAndOutput trial = known.trial(draws);
      x[i] = trial.x;
      y[i] = trial.y;
    }
    const BoundedNumber bounds = given_data_first_order(x, y, 0.95);
    const double part = 1.0 / static_cast<double>(samples);
    coverage.covered += bounds.low <= known.index && known.index <= bounds.high ? part : 0.0;
    coverage.found += bounds.low > 0.01 ? part : 0.0;
    coverage.width += part * (bounds.high - bounds.low);
  }
  return coverage;
}

/// Lower limit of the proportion of samples whose bounds cover: three standard deviations below 94 %, the
/// coverage for skewed values.
double least_coverage(std::uint64_t samples) {
  return 0.94 - 3.0 * std::sqrt(0.94 * 0.06 / static_cast<double>(samples));
}

void expect_coverage(std::size_t trials, std::uint64_t samples) {
  for (const KnownIndex& known : known_indices()) {
    const BoundsOfSamples coverage = bounds_of_samples(known, trials, samples);
    const std::string place = fmt::format("{}, {} trials", known.name, trials);
    ::testing::Test::RecordProperty(place, fmt::format("{:.3f}", coverage.covered));
    EXPECT_GE(coverage.covered, least_coverage(samples)) << place;
    if (known.index < 0.01) {
      EXPECT_LE(coverage.found, 0.025) << place << ": found what is not there";
    }
    // Bounds that cover must also tell something.
    const double of_size = known.index < 0.01 ? 0.5 : 1.0;
    if (!known.skewed && trials >= 200) {
      EXPECT_LE(coverage.width, 8.0 * of_size / std::sqrt(static_cast<double>(trials))) << place;
    }
  }
}

TEST(GivenDataCoverage, BoundsCoverTheIndexOfSkewedDiscreteAndInteractingFactors) {
  for (const std::size_t trials : {50UL, 200UL, 1000UL}) expect_coverage(trials, 300);
}

TEST(GivenDataCoverage, DISABLED_BoundsCoverTheIndexInManySamples) {
  for (const std::size_t trials : {50UL, 200UL, 1000UL, 5000UL}) expect_coverage(trials, 2000);
}

}  // namespace
}  // namespace zerocount::sensitivity

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::statistics {
namespace {

// λ·m of the lower bound, λ·cap of the upper one.
constexpr std::array<double, 12> lower_bets{0.001, 0.002, 0.004, 0.008, 0.016, 0.03,
                                            0.06,  0.12,  0.23,  0.4,   0.65,  0.9};
constexpr std::array<double, 8> upper_bets{0.03, 0.06, 0.12, 0.22, 0.36, 0.54, 0.75, 0.95};

/// Logarithm of the mean of several capitals, given their natural logarithms.
double mean_capital(std::span<const double> logarithms) {
  const double largest = std::ranges::max(logarithms);
  double sum = 0.0;
  for (const double one : logarithms) sum += numerics::exp(one - largest);
  return largest + numerics::log(sum / static_cast<double>(logarithms.size()));
}

/// Sum of ln(1 + factor(x)) over the values, computed from products of a few factors to save logarithms.
/// @param factor function with values between −1 and 1e30
template <class Factor>
double sum_of_logarithms(std::span<const double> values, const Factor& factor) {
  constexpr std::size_t at_once = 8;
  double sum = 0.0;
  for (; !values.empty(); values = values.subspan(std::min(at_once, values.size()))) {
    double product = 1.0;
    for (const double x : values.first(std::min(at_once, values.size()))) product *= 1.0 + factor(x);
    sum += numerics::log(product);
  }
  return sum;
}

struct Sample {
  std::span<const double> positive;
  double zeros;
  double cap;
};

double capital_above(const Sample& sample, double mean) {
  std::array<double, lower_bets.size()> logarithms{};
  for (std::size_t j = 0; j < lower_bets.size(); ++j) {
    const double bet = lower_bets[j];
    const double per_mean = bet / mean;
    logarithms[j] = sample.zeros * numerics::log1p(-bet) +
                    sum_of_logarithms(sample.positive, [&](double x) { return x * per_mean - bet; });
  }
  return mean_capital(logarithms);
}

double capital_below(const Sample& sample, double mean) {
  std::array<double, upper_bets.size()> logarithms{};
  for (std::size_t j = 0; j < upper_bets.size(); ++j) {
    const double bet = upper_bets[j] / sample.cap;
    logarithms[j] =
        sample.zeros * numerics::log1p(bet * mean) +
        sum_of_logarithms(sample.positive, [&](double x) { return bet * (mean - std::min(x, sample.cap)); });
  }
  return mean_capital(logarithms);
}

/// The number between `rejected` and `kept` at which `is_rejected` changes from true to false, to a relative
/// precision of 1e-6. Both ends are positive.
double boundary(double rejected, double kept, const std::function<bool(double)>& is_rejected) {
  const auto narrow = [](const numerics::Bracket& bracket) {
    return !(std::abs(bracket.fails - bracket.holds) > 1e-6 * bracket.fails);
  };
  const auto mean = [](double a, double b) { return std::sqrt(a) * std::sqrt(b); };  // a·b may underflow
  return numerics::bisect({rejected, kept}, is_rejected, narrow, mean).fails;
}

}  // namespace

ConfidenceInterval betting_bounds(std::span<const double> positive, std::int64_t n, double cap,
                                  double confidence) {
  const Sample sample{positive, static_cast<double>(n - std::ssize(positive)), cap};
  const double threshold = numerics::log(2.0 / (1.0 - confidence));
  double sum = 0.0;
  for (const double x : positive) sum += x;
  ConfidenceInterval bounds{0.0, cap};
  if (positive.empty()) {
    const auto rejects = [&](double mean) { return capital_below(sample, mean) > threshold; };
    if (n > 0 && rejects(cap)) bounds.high = boundary(cap, cap * 1e-18, rejects);
    return bounds;
  }
  const double mean = sum / static_cast<double>(n);
  const auto too_small = [&](double m) { return capital_above(sample, m) > threshold; };
  const auto too_large = [&](double m) { return capital_below(sample, m) > threshold; };
  const double smallest = mean * 1e-9;
  if (too_small(smallest)) bounds.low = boundary(smallest, mean, too_small);
  if (mean < cap && too_large(cap)) bounds.high = boundary(cap, std::min(mean, cap), too_large);
  return bounds;
}

}  // namespace zerocount::statistics

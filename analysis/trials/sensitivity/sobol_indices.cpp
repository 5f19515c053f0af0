#include "analysis/trials/sensitivity/sobol_indices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/trials/sensitivity/correlations.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_trials = 20;

struct Trial {
  double x;
  double y;
};

/// Pairs (factor x, output y) of all trials, sorted by x.
std::vector<Trial> by_factor(std::span<const double> x, std::span<const double> y) {
  std::vector<Trial> trials;
  trials.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) trials.push_back({x[i], y[i]});
  std::sort(trials.begin(), trials.end(),
            [](const Trial& a, const Trial& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  return trials;
}

/// Classes of trials that are neighbours in the factor x. `lines` is true if a class has several values of x,
/// so that a line is fitted in it, and false if it has one value and takes the mean.
struct Classes {
  std::vector<std::span<const Trial>> parts;
  bool lines{false};
};

Classes classes_of(std::span<const Trial> trials) {
  const auto most = static_cast<std::size_t>(0.5 * std::pow(static_cast<double>(trials.size()), 2.0 / 3.0));
  std::vector<std::size_t> levels;  // starts of equal x
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (i == 0 || trials[i].x != trials[i - 1].x) levels.push_back(i);
  Classes classes{.parts = {}, .lines = levels.size() > most};
  const std::size_t size = classes.lines ? trials.size() / most : 1;
  std::vector<std::size_t> starts;
  for (const std::size_t level : levels) {
    const bool room = starts.empty() || trials.size() - level >= size;
    if (room && (starts.empty() || level - starts.back() >= size)) starts.push_back(level);
  }
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : trials.size();
    classes.parts.push_back(trials.subspan(starts[k], end - starts[k]));
  }
  return classes;
}

/// [trial] Squared deviation of the output from the fit m in the trial's class, corrected for the class's
/// degrees of freedom. Also their mean, and the number of fitted coefficients of m.
struct Noise {
  std::vector<double> squares;
  double mean{0.0};
  double coefficients{0.0};
};

/// Fits a mean or, if `line`, a line to the trials of a class, and appends the squared deviations, corrected
/// for the degrees of freedom (NaN without any).
/// @returns number of coefficients of the fit
double add_squares(std::span<const Trial> part, bool line, std::vector<double>& squares) {
  const auto n = static_cast<double>(part.size());
  double x = 0.0;
  double y = 0.0;
  for (const Trial& trial : part) {
    x += trial.x / n;
    y += trial.y / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  for (const Trial& trial : part) {
    xx += (trial.x - x) * (trial.x - x);
    xy += (trial.x - x) * (trial.y - y);
  }
  const bool sloped = line && xx > 0.0;
  const double slope = sloped ? xy / xx : 0.0;
  const double coefficients = sloped ? 2.0 : 1.0;
  const double scale = n > coefficients ? n / (n - coefficients) : std::nan("");
  for (const Trial& trial : part) squares.push_back(std::pow(trial.y - y - slope * (trial.x - x), 2) * scale);
  return coefficients;
}

Noise noise_of(const Classes& classes) {
  Noise noise;
  for (const std::span<const Trial> part : classes.parts)
    noise.coefficients += add_squares(part, classes.lines, noise.squares);
  statistics::Moments known;
  for (const double square : noise.squares) known.add(square);
  noise.mean = known.mean;
  for (double& square : noise.squares)
    if (std::isnan(square)) square = noise.mean;
  return noise;
}

/// Estimate of ln(E/V) (E the residual variance of an output given a factor, V its variance), with its
/// standard error and the degrees of freedom of the error.
struct Logarithm {
  double value{0.0};
  double error{0.0};
  double degrees{0.5};
};

Logarithm logarithm_of(const Noise& noise, std::span<const Trial> trials, const statistics::Moments& y) {
  const auto n = static_cast<double>(trials.size());
  const double variance = y.sd() * y.sd();
  double squares = 0.0;
  double fourths = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    // Both terms have the mean 1, and their difference 0.
    const double of_all = std::pow(trials[i].y - y.mean, 2) / (variance * (n - 1.0) / n);
    const double influence = noise.squares[i] / noise.mean - of_all;
    squares += influence * influence;
    fourths += std::pow(influence, 4);
  }
  const double carrying = fourths > 0.0 ? squares * squares / fourths : n;
  return {std::log(noise.mean / variance), std::sqrt(squares + 2.0 * (noise.coefficients - 1.0)) / n,
          std::max(0.5 * carrying - 1.0, 0.5)};
}

/// Upper confidence bound of a first-order Sobol' index whose estimate is close to 0.
/// @param coefficients number p of fitted coefficients
/// @param n number of trials
double bound_near_zero(double index, double coefficients, double n, double confidence) {
  const double z2 = std::pow(statistics::two_sided_normal_quantile(confidence), 2);
  const double a = 1.0 + 4.0 * z2 / n;
  const double b = index + 2.0 * z2 / n;
  const double c = index * index - 2.0 * z2 * (coefficients - 1.0) / (n * n);
  return (b + std::sqrt(std::max(b * b - a * c, 0.0))) / a;
}

constexpr Eigen::Index max_groups = 4096;
constexpr double min_behind_variance = 20.0;

// The estimates are functions of sums over the rows: of the first ones, and for each factor of c, c², bc, (a
// − c)².
enum CommonSum : Eigen::Index { of_rows, of_a, of_b, of_a_squared, of_b_squared, of_ab, common_sums };
enum FactorSum : Eigen::Index { of_c, of_c_squared, of_bc, of_difference_squared, sums_per_factor };

Eigen::MatrixXd sums_by_group(const SaltelliSample& sample, double origin) {
  const auto rows = static_cast<Eigen::Index>(sample.a.size());
  const auto factors = static_cast<Eigen::Index>(sample.c.size());
  const Eigen::Index groups = std::min(rows, max_groups);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(common_sums + sums_per_factor * factors, groups);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto r = static_cast<std::size_t>(row);
    auto column = sums.col(row * groups / rows);
    const double a = sample.a[r] - origin;
    const double b = sample.b[r] - origin;
    column.head<common_sums>() += Eigen::Vector<double, common_sums>{1.0, a, b, a * a, b * b, a * b};
    for (Eigen::Index j = 0; j < factors; ++j) {
      const double c = sample.c[static_cast<std::size_t>(j)][r] - origin;
      column.segment<sums_per_factor>(common_sums + sums_per_factor * j) +=
          Eigen::Vector<double, sums_per_factor>{c, c * c, b * c, (a - c) * (a - c)};
    }
  }
  return sums;
}

struct IndexValues {
  double first_order;
  double total;
};

double variance_of_both(double sum, double squares, double rows) {
  const double mean = sum / (2.0 * rows);
  return squares / (2.0 * rows) - mean * mean;
}

IndexValues index_values(const Eigen::VectorXd& sums, Eigen::Index factor, double control) {
  const double rows = sums(of_rows);
  const auto own = sums.segment<sums_per_factor>(common_sums + sums_per_factor * factor);
  const double mean_bc = (sums(of_b) + own(of_c)) / (2.0 * rows);
  const double covariance_ab = sums(of_ab) / rows - sums(of_a) * sums(of_b) / (rows * rows);
  const double alone = own(of_bc) / rows - mean_bc * mean_bc - control * covariance_ab;
  const double variance_bc =
      variance_of_both(sums(of_b) + own(of_c), sums(of_b_squared) + own(of_c_squared), rows);
  const double variance_ac =
      variance_of_both(sums(of_a) + own(of_c), sums(of_a_squared) + own(of_c_squared), rows);
  return {own(of_difference_squared) == 0.0 ? 0.0 : alone / variance_bc,
          own(of_difference_squared) / (2.0 * rows * variance_ac)};
}

// λ of a factor.
// @param without S of the factor with λ = 0.
double control_coefficient(const SaltelliSample& sample, std::size_t factor, double without, double origin) {
  const auto rows = static_cast<Eigen::Index>(sample.a.size());
  const auto centred = [&](const std::vector<double>& values) -> Eigen::ArrayXd {
    return Eigen::ArrayXd::Map(values.data(), rows) - origin;
  };
  const Eigen::ArrayXd b = centred(sample.b);
  const Eigen::ArrayXd c = centred(sample.c[factor]);
  const Eigen::ArrayXd control = centred(sample.a) * b;
  const Eigen::ArrayXd influence = b * c - 0.5 * without * (b.square() + c.square());
  const Eigen::ArrayXd about_mean = control - control.mean();
  const double squares = about_mean.square().sum();
  return squares > 0.0 ? (influence * about_mean).sum() / squares : 0.0;
}

/// [row of a saltelli design] Influence function of the rows on the two Sobol' indices of a factor:
/// derivative of the index with respect to the weight of the row, times the number of rows.
struct Influences {
  Eigen::ArrayXd first_order;
  Eigen::ArrayXd total;
};

// With V the variance of the two columns, of which (x² + y²)/2 is a row's part, all less their means:
// S = (Σ bc − λ Σ ab)/(N V) and T = Σ (a − c)²/(2 N V).
Influences influences_of(const SaltelliSample& sample, std::size_t factor, const SobolIndices& indices,
                         double control) {
  const auto rows = static_cast<Eigen::Index>(sample.a.size());
  const auto values = [&](const std::vector<double>& column) -> Eigen::ArrayXd {
    return Eigen::ArrayXd::Map(column.data(), rows);
  };
  const Eigen::ArrayXd a = values(sample.a);
  const Eigen::ArrayXd b = values(sample.b);
  const Eigen::ArrayXd c = values(sample.c[factor]);
  const auto influence = [](const Eigen::ArrayXd& numerator, const Eigen::ArrayXd& variance, double index) {
    const Eigen::ArrayXd all = (numerator - index * variance) / variance.mean();
    return Eigen::ArrayXd(all - all.mean());
  };
  const double mean_bc = 0.5 * (b.mean() + c.mean());
  const double mean_ac = 0.5 * (a.mean() + c.mean());
  const Eigen::ArrayXd alone = (b - mean_bc) * (c - mean_bc) - control * (a - a.mean()) * (b - b.mean());
  return {
      influence(alone, 0.5 * ((b - mean_bc).square() + (c - mean_bc).square()), indices.first_order.value),
      influence(0.5 * (a - c).square(), 0.5 * ((a - mean_ac).square() + (c - mean_ac).square()),
                indices.total.value)};
}

// Widens the bounds to value ± t·s.
void widen_by_influence(const Eigen::ArrayXd& influence, double confidence, BoundedNumber& number) {
  const double squares = influence.square().sum();
  if (!(squares > 0.0)) return;  // or not a number
  const double carrying = squares * (squares / influence.square().square().sum());
  const double degrees = std::max(0.5, 0.5 * carrying - 1.0);
  const double error = std::sqrt(squares) / static_cast<double>(influence.size());
  const double half = statistics::student_t_quantile(degrees, 0.5 + 0.5 * confidence) * error;
  number.low = std::min(number.low, number.value - half);
  number.high = std::max(number.high, number.value + half);
}

// How often each group is in the sample drawn anew.
Eigen::VectorXd draw_groups(Eigen::Index groups, std::int64_t replicate,
                            const random::RandomStream& randomness) {
  Eigen::VectorXd times = Eigen::VectorXd::Zero(groups);
  for (Eigen::Index i = 0; i < groups; ++i) {
    const auto index = static_cast<std::uint64_t>(replicate * groups + i);
    const double u = random::open_uniform(random::random_bits(randomness, index, random::Draw::trial));
    times(std::min(static_cast<Eigen::Index>(u * static_cast<double>(groups)), groups - 1)) += 1.0;
  }
  return times;
}

// The percentiles at (1 ∓ confidence)/2 of the finite values: those with the ranks that leave as many beyond.
void set_bounds(std::vector<double> values, double confidence, BoundedNumber& number) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
               values.end());
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const double last = static_cast<double>(values.size() - 1);
  const double beyond = 0.5 * (1.0 - confidence) * last;
  number.low = values[static_cast<std::size_t>(std::floor(beyond))];
  number.high = values[static_cast<std::size_t>(std::ceil(last - beyond))];
}

bool has_variance(const SaltelliSample& sample) {
  const auto differs = [&](double value) { return value != sample.a.front(); };
  return std::any_of(sample.a.begin(), sample.a.end(), differs) ||
         std::any_of(sample.b.begin(), sample.b.end(), differs);
}

double mean_of(const SaltelliSample& sample) {
  double sum = 0.0;
  for (std::size_t r = 0; r < sample.a.size(); ++r) sum += sample.a[r] + sample.b[r];
  return sum / (2.0 * static_cast<double>(sample.a.size()));
}

bool is_yes_or_no(const SaltelliSample& sample) {
  const auto says = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0 || v == 1.0; });
  };
  return says(sample.a) && says(sample.b) && std::all_of(sample.c.begin(), sample.c.end(), says);
}

// 1 − D, of B and a column with one factor in common.
BoundedNumber rest_of(const BoundedNumber& difference) {
  return {1.0 - difference.value, 1.0 - difference.high, 1.0 - difference.low};
}

// The wider of the bounds by resampling and those without a control variate.
BoundedNumber yes_no_first_order(const BoundedNumber& resampled, const BoundedNumber& difference) {
  if (std::isnan(difference.value)) return {};
  const BoundedNumber held = clamped_index(resampled);
  const BoundedNumber rest = clamped_index(rest_of(difference));
  return {held.value, std::fmin(held.low, rest.low), std::fmax(held.high, rest.high)};
}

BoundedNumber number_total(const BoundedNumber& resampled, double unseen, double confidence) {
  BoundedNumber total = clamped_index(with_unseen(resampled, unseen));
  // A factor without influence changes no row. A resampled bound of 0 says that few rows differ; at the least
  // it is the bound of a Poisson mean of which one event is seen.
  const double of_one_event = -std::log1p(-0.5 * (1.0 - confidence)) * total.value;
  total.low = std::fmin(std::fmax(std::fmin(resampled.low, 1.0), of_one_event), total.value);
  if (resampled.value > 1.0) total.low = std::fmin(total.low, clamped_index(resampled).low);
  return total;
}

BoundedNumber without_bounds(const BoundedNumber& number) {
  BoundedNumber value;
  value.value = number.value;
  return value;
}

// From bounds by resampling to such as hold where few rows differ, too: resampling hardly ever meets those.
void widen_bounds(const SaltelliSample& sample, double confidence, std::vector<SobolIndices>& indices) {
  const bool yes_or_no = is_yes_or_no(sample);
  const double unseen = unseen_index(sample.a, sample.b, confidence);
  std::vector<double> of_a_and_b = sample.a;
  of_a_and_b.insert(of_a_and_b.end(), sample.b.begin(), sample.b.end());
  const bool too_few = values_behind_variance(of_a_and_b) < min_behind_variance;
  for (std::size_t j = 0; j < sample.c.size(); ++j) {
    auto& [first_order, total] = indices[j];
    const std::vector<double>& c = sample.c[j];
    if (yes_or_no) {
      total = clamped_index(yes_no_difference(answer_pairs(sample.a, c), confidence));
      first_order = yes_no_first_order(first_order, yes_no_difference(answer_pairs(sample.b, c), confidence));
    } else {
      total = number_total(total, unseen, confidence);
      first_order = clamped_index(with_unseen(first_order, unseen));
    }
    if (!yes_or_no && too_few) {
      total = without_bounds(total);
      first_order = without_bounds(first_order);
      continue;
    }
    // No factor explains more alone than it has a part in.
    if (std::isnan(total.value)) first_order = {};
    first_order.high = std::max(first_order.value, std::min(first_order.high, total.high));
  }
}

}  // namespace

double values_behind_variance(std::span<const double> values) {
  statistics::Moments moments;
  for (const double value : values) moments.add(value);
  double fourths = 0.0;
  for (const double value : values) fourths += std::pow(value - moments.mean, 4);
  return moments.squares * (moments.squares / fourths);
}

BoundedNumber given_data_first_order(std::span<const double> x, std::span<const double> y,
                                     double confidence) {
  if (x.size() < min_trials || is_constant(x) || is_constant(y)) return {};
  const std::vector<Trial> trials = by_factor(x, y);
  const Noise noise = noise_of(classes_of(trials));
  statistics::Moments moments;
  for (const Trial& trial : trials) moments.add(trial.y);
  if (!(noise.mean > 0.0)) return {1.0, 1.0, 1.0};

  const auto n = static_cast<double>(x.size());
  const double extreme = 0.5 + 0.5 * confidence;
  const Logarithm logarithm = logarithm_of(noise, trials, moments);
  const double half = statistics::student_t_quantile(logarithm.degrees, extreme) * logarithm.error;
  const double by_chance =
      (statistics::chi_squared_quantile(noise.coefficients - 1.0, extreme) - (noise.coefficients - 1.0)) / n;
  const double index = 1.0 - std::exp(logarithm.value);
  const double low = 1.0 - std::exp(logarithm.value + std::max(half, by_chance));
  double high = 1.0 - std::exp(logarithm.value - half);
  if (low <= 0.0) high = std::max(high, bound_near_zero(index, noise.coefficients, n, confidence));
  return clamped_index({index, low, high});
}

std::int64_t bootstrap_replicates(double confidence) {
  constexpr double beyond_each_bound = 25.0;
  return std::max<std::int64_t>(1000,
                                std::llround(std::ceil(beyond_each_bound / (0.5 * (1.0 - confidence)))));
}

std::vector<SobolIndices> saltelli_indices(const SaltelliSample& sample, double confidence,
                                           const random::RandomStream& randomness) {
  const std::size_t factors = sample.c.size();
  std::vector<SobolIndices> indices(factors);
  if (sample.a.size() < 2 || !has_variance(sample)) return indices;
  const double origin = mean_of(sample);
  const Eigen::MatrixXd sums = sums_by_group(sample, origin);
  const Eigen::VectorXd all = sums.rowwise().sum();
  std::vector<double> controls;
  for (std::size_t j = 0; j < factors; ++j) {
    const double without = index_values(all, static_cast<Eigen::Index>(j), 0.0).first_order;
    controls.push_back(control_coefficient(sample, j, without, origin));
    const IndexValues values = index_values(all, static_cast<Eigen::Index>(j), controls[j]);
    indices[j].first_order.value = values.first_order;
    indices[j].total.value = values.total;
  }

  const std::int64_t replicates = bootstrap_replicates(confidence);
  const std::vector<double> unset(static_cast<std::size_t>(replicates));
  std::vector<std::vector<double>> first_orders(factors, unset);
  std::vector<std::vector<double>> totals(factors, unset);
  parallel::for_each_index(static_cast<std::size_t>(replicates), [&](std::size_t r) {
    const auto replicate = static_cast<std::int64_t>(r);
    const Eigen::VectorXd drawn = sums * draw_groups(sums.cols(), replicate, randomness);
    for (std::size_t j = 0; j < factors; ++j) {
      const IndexValues values = index_values(drawn, static_cast<Eigen::Index>(j), controls[j]);
      first_orders[j][r] = values.first_order;
      totals[j][r] = values.total;
    }
  });
  for (std::size_t j = 0; j < factors; ++j) {
    set_bounds(std::move(first_orders[j]), confidence, indices[j].first_order);
    set_bounds(std::move(totals[j]), confidence, indices[j].total);
    if (is_yes_or_no(sample)) continue;
    const Influences influences = influences_of(sample, j, indices[j], controls[j]);
    widen_by_influence(influences.first_order, confidence, indices[j].first_order);
    widen_by_influence(influences.total, confidence, indices[j].total);
  }
  widen_bounds(sample, confidence, indices);
  return indices;
}

}  // namespace zerocount::sensitivity

#include "analysis/pairs/two_samples/continued_sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/pairs/two_samples/exact_tests.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::two_samples {
namespace {

constexpr std::int64_t max_blocks = 1000;
constexpr std::uint32_t continuation_key = 0x636f6e74;

/// Indices of the sums over the units of a sample. Pairs have differences d, other samples the values v of
/// one file.
enum Sum : std::size_t {
  units = 0,  ///< Number of units with a value.
  /// Σd or Σv. For failures: their number; for pairs of failures: the pairs that failed only in the current
  /// file.
  values = 1,
  /// Σd² or Σv². For pairs of failures: the pairs that failed only in the baseline.
  squares = 2,
  /// For pairs: Σ of the signed ranks. Otherwise: number of values up to the place of the largest excess.
  worse_rank = 3,
  /// For pairs: Σ of the squared ranks. Otherwise: number of values up to the place of the largest opposite
  /// excess.
  better_rank = 4,
};

std::vector<Sums> pairs_of(const Sample& sample) {
  std::vector<Sums> pairs(sample.current.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double difference = sample.current[i] - sample.baseline[i];
    if (std::isnan(difference)) continue;
    pairs[i][units] = 1.0;
    pairs[i][values] = sample.failures ? static_cast<double>(difference > 0.0) : difference;
    pairs[i][squares] = sample.failures ? static_cast<double>(difference < 0.0) : difference * difference;
  }
  return pairs;
}

/// Stores, for each pair, the signed rank of its difference (and its square); differences of 0 have none, and
/// equal sizes share their mean rank.
void add_signed_ranks(std::vector<Sums>& pairs) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i][values] != 0.0) order.push_back(i);
  }
  const auto size = [&](std::size_t i) { return std::abs(pairs[i][values]); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size(a) < size(b); });
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && size(order[end]) == size(order[first])) ++end;
    const double rank = 0.5 * static_cast<double>(first + 1 + end) / static_cast<double>(order.size());
    for (; first < end; ++first) {
      Sums& pair = pairs[order[first]];
      pair[worse_rank] = std::copysign(rank, pair[values]);
      pair[better_rank] = rank * rank;
    }
  }
}

/// The value x at which the empirical distribution of `one` exceeds that of `other` most, both sorted.
double place_of_excess(const std::vector<double>& one, const std::vector<double>& other) {
  double place = one.empty() ? 0.0 : one.front();
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (i + 1 < one.size() && one[i + 1] == one[i]) continue;
    const auto up_to = std::upper_bound(other.begin(), other.end(), one[i]) - other.begin();
    const double excess = static_cast<double>(i + 1) / static_cast<double>(one.size()) -
                          static_cast<double>(up_to) / static_cast<double>(other.size());
    if (excess <= largest) continue;
    largest = excess;
    place = one[i];
  }
  return place;
}

/// [file][unit] Sums of each single unit of both files. Values are counted from the mean of the baseline, so
/// that squares lose no digits.
std::array<std::vector<Sums>, 2> units_of(const Sample& sample) {
  std::vector<double> before = known(sample.baseline);
  std::vector<double> after = known(sample.current);
  std::ranges::sort(before);
  std::ranges::sort(after);
  const double centre = sample.failures || before.empty() ? 0.0 : mean_of(before);
  const double worse_place = place_of_excess(before, after);
  const double better_place = place_of_excess(after, before);
  const auto of_file = [&](const std::vector<double>& all) {
    std::vector<Sums> sums(all.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (std::isnan(all[i])) continue;
      const double value = all[i] - centre;
      sums[i] = {1.0,
                 value,
                 value * value,
                 static_cast<double>(all[i] <= worse_place),
                 static_cast<double>(all[i] <= better_place),
                 0.0};
    }
    return sums;
  };
  return {of_file(sample.baseline), of_file(sample.current)};
}

std::int64_t whole(double number) {
  return std::max<std::int64_t>(0, std::llround(number));
}

FailureCounts counts_of(const FileSums& sums) {
  const std::int64_t n1 = whole(sums[0][units]);
  const std::int64_t n2 = whole(sums[1][units]);
  return {std::min(n1, whole(sums[0][values])), n1, std::min(n2, whole(sums[1][values])), n2};
}

/// One-sided p-value of Smirnov's test by its limit distribution, from the excess of the first file's
/// empirical distribution at one value.
/// @param place index in Sums of the number of values up to that value
double excess_p(const Sums& one, const Sums& other, std::size_t place) {
  const double excess = one[place] / one[units] - other[place] / other[units];
  if (excess <= 0.0) return 1.0;
  return std::exp(-2.0 * excess * excess * one[units] * other[units] / (one[units] + other[units]));
}

/// Updates the sums as if `effect` were subtracted from the value of each unit.
void shift(Sums& sums, double effect) {
  sums[squares] += effect * (effect * sums[units] - 2.0 * sums[values]);
  sums[values] -= effect * sums[units];
}

/// Upper tail probability P(count ≥ seen) of a count with this mean and variance, by the normal distribution
/// with a continuity correction.
double upper_tail_of_count(double seen, double mean, double variance) {
  if (variance <= 0.0) return 1.0;
  return statistics::normal_upper_tail((seen - mean - 0.5) / std::sqrt(variance));
}

/// Adds to the change the p-values of a change within ± margin. They come from its bounds, taken as those of
/// a normal distribution.
Change with_margin(Change change, double confidence, double margin) {
  change.beyond = {change.p, change.improvement_p};
  if (margin == 0.0) return change;
  const double z = statistics::normal_quantile(confidence);
  const double low = z * (change.effect - margin) / std::max(change.effect - change.bounds.low, 1e-300);
  const double high = z * (-change.effect - margin) / std::max(change.bounds.high - change.effect, 1e-300);
  change.beyond.worse = std::max(change.p, statistics::normal_upper_tail(low));
  change.beyond.better = std::max(change.improvement_p, statistics::normal_upper_tail(high));
  return change;
}

Change change_of_pairs(const PairedFailures& failures, double confidence) {
  const auto worse = static_cast<double>(failures.only_current);
  const auto better = static_cast<double>(failures.only_baseline);
  const double differing = worse + better;
  return {(worse - better) / static_cast<double>(failures.pairs), tango(failures, confidence),
          upper_tail_of_count(worse, 0.5 * differing, 0.25 * differing),
          upper_tail_of_count(better, 0.5 * differing, 0.25 * differing)};
}

/// Change of the failures of two independent samples. The p-values come from the normal approximation with
/// the hypergeometric variance.
Change change_of_failures(const FailureCounts& failures, double confidence) {
  const auto n1 = static_cast<double>(failures.baseline_trials);
  const auto n2 = static_cast<double>(failures.current_trials);
  const auto f1 = static_cast<double>(failures.baseline_failures);
  const auto f2 = static_cast<double>(failures.current_failures);
  const double rate = (f1 + f2) / (n1 + n2);
  const double variance = rate * (1.0 - rate) * n1 * n2 / (n1 + n2 - 1.0);
  return {f2 / n2 - f1 / n1, newcombe(failures, confidence), upper_tail_of_count(f2, rate * n2, variance),
          upper_tail_of_count(f1, rate * n1, variance)};
}

/// Approximate quantile of Student's t distribution (Cornish–Fisher expansion), quick enough for simulations.
double quick_t_quantile(double confidence, double degrees_of_freedom) {
  const double z = statistics::normal_quantile(confidence);
  const double v = degrees_of_freedom;
  return z + (z * z * z + z) / (4.0 * v) +
         (5.0 * std::pow(z, 5) + 16.0 * z * z * z + 3.0 * z) / (96.0 * v * v);
}

/// A mean or a difference of means, the square of its standard error, and its degrees of freedom.
struct QuickMean {
  double value{0.0};
  double variance{0.0};
  double degrees_of_freedom{1.0};
};

/// Approximate upper tail probability of Student's t for mean over standard error (Wallace's approximation).
double upper_tail(const QuickMean& mean) {
  if (mean.variance <= 0.0) return mean.value > 0.0 ? 0.0 : mean.value < 0.0 ? 1.0 : 0.5;
  const double t = mean.value / std::sqrt(mean.variance);
  const double v = mean.degrees_of_freedom;
  const double size = (8.0 * v + 1.0) / (8.0 * v + 3.0) * std::sqrt(v * std::log1p(t * t / v));
  return statistics::normal_upper_tail(std::copysign(size, t));
}

double reach(const QuickMean& mean, double confidence) {
  if (mean.variance <= 0.0) return 0.0;
  return quick_t_quantile(confidence, mean.degrees_of_freedom) * std::sqrt(mean.variance);
}

QuickMean quick_mean(const Sums& sums) {
  const double n = sums[units];
  const double sum_of_squares = std::max(0.0, sums[squares] - sums[values] * sums[values] / n);
  return {sums[values] / n, sum_of_squares / (n - 1.0) / n, n - 1.0};
}

/// The mean of the values if one more value is added, `distance` beyond the present mean.
QuickMean with_one_more(const Sums& sums, double distance) {
  const double value = sums[values] / sums[units] + distance;
  return quick_mean({sums[units] + 1.0, sums[values] + value, sums[squares] + value * value});
}

/// Difference of two means, current − baseline, with Welch's standard error and degrees of freedom.
QuickMean difference_of(const QuickMean& baseline, const QuickMean& current) {
  const double variance = baseline.variance + current.variance;
  const double spread = baseline.variance * baseline.variance / baseline.degrees_of_freedom +
                        current.variance * current.variance / current.degrees_of_freedom;
  return {current.value - baseline.value, variance, spread > 0.0 ? variance * variance / spread : 1.0};
}

}  // namespace

std::uint64_t continuation_bits(std::uint32_t simulation, std::uint32_t stream, std::uint64_t index,
                                ContinuationDraw draw) {
  return random::random_bits({{continuation_key, stream}, simulation}, index,
                             static_cast<std::uint32_t>(draw));
}

double poisson_number(double mean, std::uint64_t bits) {
  if (mean >= 30.0) return std::max(0.0, std::round(mean + std::sqrt(mean) * random::standard_normal(bits)));
  double remaining = random::open_uniform(bits);
  double probability = std::exp(-mean);
  double number = 0.0;
  while (remaining > probability && probability > 0.0) {
    remaining -= probability;
    number += 1.0;
    probability *= mean / number;
  }
  return number;
}

Continuation::Continuation(std::int64_t units, std::uint32_t stream)
    : units_(units), stream_(stream), blocks_(static_cast<std::size_t>(std::min(units, max_blocks))) {}

std::size_t Continuation::block_of(std::int64_t unit) const {
  return static_cast<std::size_t>(unit * static_cast<std::int64_t>(blocks_) / units_);
}

double Continuation::size_of(std::size_t block) const {
  const auto count = static_cast<std::int64_t>(blocks_);
  const auto first = [&](std::int64_t number) { return (number * units_ + count - 1) / count; };
  const auto number = static_cast<std::int64_t>(block);
  return static_cast<double>(first(number + 1) - first(number));
}

std::vector<double> Continuation::population(std::uint32_t simulation) const {
  std::vector<double> weights(blocks_);
  double sum = 0.0;
  for (std::size_t block = 0; block < blocks_; ++block) {
    const std::uint64_t bits = continuation_bits(simulation, stream_, block, ContinuationDraw::population);
    weights[block] = -size_of(block) * std::log(random::open_uniform(bits));
    sum += weights[block];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> Continuation::further_units(const std::vector<double>& population, double more,
                                                std::uint32_t simulation) const {
  std::vector<double> numbers(blocks_);
  for (std::size_t block = 0; block < blocks_; ++block) {
    const double size = size_of(block);
    const std::uint64_t bits = continuation_bits(simulation, stream_, block, ContinuationDraw::further_units);
    numbers[block] = size * poisson_number(more * population[block] / size, bits);
  }
  return numbers;
}

void add(Sums& sums, const Sums& more) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += more[i];
}

BlockedSums::BlockedSums(const std::vector<Sums>& units, const Continuation& continuation)
    : blocks_(continuation.blocks()) {
  for (std::size_t unit = 0; unit < units.size(); ++unit) {
    const std::size_t block = continuation.block_of(static_cast<std::int64_t>(unit));
    add(seen_, units[unit]);
    for (std::size_t i = 0; i < seen_.size(); ++i)
      blocks_[block][i] += units[unit][i] / continuation.size_of(block);
  }
}

Sums BlockedSums::weighted(const std::vector<double>& weights) const {
  Sums sums{};
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weights[block] * blocks_[block][i];
  }
  return sums;
}

ContinuedSample::ContinuedSample(const Sample& sample, const std::array<Continuation, 2>& continuations)
    : failures_(sample.failures), paired_(sample.paired), plausible_(sample.plausible) {
  if (paired_) {
    std::vector<Sums> pairs = pairs_of(sample);
    if (!failures_) add_signed_ranks(pairs);
    files_[0] = BlockedSums(pairs, continuations[0]);
    return;
  }
  const auto [before, after] = units_of(sample);
  files_ = {BlockedSums(before, continuations[0]), BlockedSums(after, continuations[1])};
}

FileSums ContinuedSample::weighted(const FileWeights& weights) const {
  return {files_[0].weighted(weights[0]), paired_ ? Sums{} : files_[1].weighted(weights[1])};
}

void ContinuedSample::remove_effect(FileSums& further, const FileSums& population) const {
  if (failures_ && paired_) {
    const double half =
        0.5 * further[0][units] * (population[0][values] - population[0][squares]) / population[0][units];
    further[0][values] = std::max(0.0, further[0][values] - half);
    further[0][squares] = std::max(0.0, further[0][squares] + half);
    return;
  }
  if (paired_) {
    shift(further[0], population[0][values] / population[0][units]);
    return;
  }
  const double effect =
      population[1][values] / population[1][units] - population[0][values] / population[0][units];
  if (!failures_) {
    shift(further[1], effect);
    return;
  }
  further[0][values] = std::max(0.0, further[0][values] + 0.5 * effect * further[0][units]);
  further[1][values] = std::max(0.0, further[1][values] - 0.5 * effect * further[1][units]);
}

void ContinuedSample::add_unseen(Sums& sums, double first_kind, double second_kind) const {
  sums[units] += first_kind + second_kind;
  sums[values] += first_kind;
  if (paired_) sums[squares] += second_kind;
}

Change ContinuedSample::change_of(const FileSums& sums, double confidence, bool ranks, double margin) const {
  if (!failures_) return change_of_means(sums, confidence, ranks, margin);
  const Change change =
      paired_ ? change_of_pairs({whole(sums[0][units]), whole(sums[0][values]), whole(sums[0][squares])},
                                confidence)
              : change_of_failures(counts_of(sums), confidence);
  return with_margin(change, confidence, margin);
}

Change ContinuedSample::change_of_means(const FileSums& sums, double confidence, bool ranks,
                                        double margin) const {
  const auto difference = [&](const QuickMean& changed) {
    return paired_ ? changed : difference_of(quick_mean(sums[0]), changed);
  };
  const Sums& changed = paired_ ? sums[0] : sums[1];
  const QuickMean mean = difference(quick_mean(changed));
  const QuickMean low = difference(with_one_more(changed, -plausible_));
  const QuickMean high = difference(with_one_more(changed, plausible_));
  const double tail = upper_tail(mean);
  Change change{mean.value,
                {low.value - reach(low, confidence), high.value + reach(high, confidence)},
                tail,
                1.0 - tail};
  if (!ranks) return with_margin(change, confidence, margin);
  double worse = excess_p(sums[0], sums[1], worse_rank);
  double better = excess_p(sums[1], sums[0], better_rank);
  if (paired_) {
    const double z = sums[0][worse_rank] / std::sqrt(std::max(sums[0][better_rank], 1e-300));
    worse = statistics::normal_upper_tail(z);
    better = statistics::normal_upper_tail(-z);
  }
  change.p = std::max(change.p, worse);
  change.improvement_p = std::max(change.improvement_p, better);
  return with_margin(change, confidence, margin);
}

statistics::ConfidenceInterval quick_bounds(const Sums& sums, double plausible, double low_confidence,
                                            double high_confidence) {
  const QuickMean low = with_one_more(sums, -plausible);
  const QuickMean high = with_one_more(sums, plausible);
  return {low.value - reach(low, low_confidence), high.value + reach(high, high_confidence)};
}

}  // namespace zerocount::two_samples

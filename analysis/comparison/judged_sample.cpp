#include "analysis/comparison/judged_sample.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/statistics/distributions.hpp"

namespace zerocount::comparison {
namespace {

/// The sums of a sample. Pairs have differences d, other samples the values v of one file.
enum Sum : std::size_t {
  units = 0,        ///< with a value
  values = 1,       ///< Σd or Σv; of proportions failures, of pairs those of the current file alone
  squares = 2,      ///< Σd² or Σv²; of pairs of proportions the failures of the baseline alone
  worse_rank = 3,   ///< pairs: Σ of the signed ranks; else values up to the place of the largest excess
  better_rank = 4,  ///< pairs: Σ of the squared ranks; else likewise of the opposite excess
};

bool has_value(double value) {
  return !std::isnan(value);
}

std::vector<SampleSums> rows_of_pairs(const MeasureSample& sample) {
  std::vector<SampleSums> rows(sample.current.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double difference = sample.current[i] - sample.baseline[i];
    if (!has_value(difference)) continue;
    rows[i][units] = 1.0;
    rows[i][values] = sample.proportion ? static_cast<double>(difference > 0.0) : difference;
    rows[i][squares] = sample.proportion ? static_cast<double>(difference < 0.0) : difference * difference;
  }
  return rows;
}

/// Adds the signed ranks of the differences that are not 0; equal sizes share their mean rank.
void add_signed_ranks(std::vector<SampleSums>& rows) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i][values] != 0.0) order.push_back(i);
  }
  const auto size = [&](std::size_t i) { return std::abs(rows[i][values]); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size(a) < size(b); });
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && size(order[end]) == size(order[first])) ++end;
    const double rank = 0.5 * static_cast<double>(first + 1 + end) / static_cast<double>(order.size());
    for (; first < end; ++first) {
      SampleSums& row = rows[order[first]];
      row[worse_rank] = std::copysign(rank, row[values]);
      row[better_rank] = rank * rank;
    }
  }
}

std::vector<double> sorted_values(const std::vector<double>& sample) {
  std::vector<double> sorted;
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(sorted), has_value);
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The value up to which `one` has the largest excess of values over `other`.
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

/// The values up to which each file has the largest excess over the other.
struct ExcessPlaces {
  double worse{0.0};
  double better{0.0};
};

std::vector<SampleSums> rows_of_file(const std::vector<double>& sample, double centre, bool proportion,
                                     const ExcessPlaces& places) {
  std::vector<SampleSums> rows(sample.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!has_value(sample[i])) continue;
    const double value = proportion ? sample[i] : sample[i] - centre;
    rows[i] = {1.0,
               value,
               value * value,
               static_cast<double>(sample[i] <= places.worse),
               static_cast<double>(sample[i] <= places.better),
               0.0};
  }
  return rows;
}

std::int64_t whole(double number) {
  return std::max<std::int64_t>(0, std::llround(number));
}

two_samples::FailureCounts counts_of(const FileSums& sums) {
  const std::int64_t n1 = whole(sums[0][units]);
  const std::int64_t n2 = whole(sums[1][units]);
  return {std::min(n1, whole(sums[0][values])), n1, std::min(n2, whole(sums[1][values])), n2};
}

two_samples::ValueSums values_of(const SampleSums& sums) {
  return {sums[units], sums[values], sums[squares]};
}

/// Smirnov's limit, of the excess of the first file's values at one place.
double excess_p(const SampleSums& one, const SampleSums& other, std::size_t place) {
  const double excess = one[place] / one[units] - other[place] / other[units];
  if (excess <= 0.0) return 1.0;
  return std::exp(-2.0 * excess * excess * one[units] * other[units] / (one[units] + other[units]));
}

/// Takes `effect` from each of the units.
void shift(SampleSums& sums, double effect) {
  sums[squares] += effect * (effect * sums[units] - 2.0 * sums[values]);
  sums[values] -= effect * sums[units];
}

}  // namespace

BlockedSums::BlockedSums(const std::vector<SampleSums>& rows, const two_samples::Continuation& continuation)
    : blocks_(continuation.blocks()) {
  for (std::size_t unit = 0; unit < rows.size(); ++unit) {
    const std::size_t block = continuation.block_of(static_cast<std::int64_t>(unit));
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      seen_[i] += rows[unit][i];
      blocks_[block][i] += rows[unit][i] / continuation.size_of(block);
    }
  }
}

SampleSums BlockedSums::weighted(const std::vector<double>& weights) const {
  SampleSums sums{};
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += weights[block] * blocks_[block][i];
  }
  return sums;
}

JudgedMeasure::JudgedMeasure(const MeasureSample& sample,
                             const std::array<two_samples::Continuation, 2>& continuations)
    : proportion_(sample.proportion), paired_(sample.paired), plausible_(sample.plausible) {
  if (paired_) {
    std::vector<SampleSums> rows = rows_of_pairs(sample);
    if (!proportion_) add_signed_ranks(rows);
    files_[0] = BlockedSums(rows, continuations[0]);
    return;
  }
  const std::vector<double> before = sorted_values(sample.baseline);
  const std::vector<double> after = sorted_values(sample.current);
  const double centre = before.empty() ? 0.0
                                       : std::accumulate(before.begin(), before.end(), 0.0) /
                                             static_cast<double>(before.size());
  const ExcessPlaces places{place_of_excess(before, after), place_of_excess(after, before)};
  files_[0] = BlockedSums(rows_of_file(sample.baseline, centre, proportion_, places), continuations[0]);
  files_[1] = BlockedSums(rows_of_file(sample.current, centre, proportion_, places), continuations[1]);
}

FileSums JudgedMeasure::weighted(const FileWeights& weights) const {
  return {files_[0].weighted(weights[0]), paired_ ? SampleSums{} : files_[1].weighted(weights[1])};
}

void JudgedMeasure::remove_effect(FileSums& further, const FileSums& population) const {
  if (proportion_ && paired_) {
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
  if (!proportion_) {
    shift(further[1], effect);
    return;
  }
  further[0][values] = std::max(0.0, further[0][values] + 0.5 * effect * further[0][units]);
  further[1][values] = std::max(0.0, further[1][values] - 0.5 * effect * further[1][units]);
}

void JudgedMeasure::add_unseen(SampleSums& sums, double first_kind, double second_kind) const {
  if (!proportion_) return;
  sums[units] += first_kind + second_kind;
  sums[values] += first_kind;
  if (paired_) sums[squares] += second_kind;
}

two_samples::QuickResult JudgedMeasure::test(const FileSums& sums, double confidence, bool ranks) const {
  if (!proportion_) return test_means(sums, confidence, ranks);
  if (!paired_) return two_samples::quick_proportion(counts_of(sums), confidence);
  return two_samples::quick_paired_proportion(
      {whole(sums[0][units]), whole(sums[0][values]), whole(sums[0][squares])}, confidence);
}

two_samples::QuickResult JudgedMeasure::test_means(const FileSums& sums, double confidence,
                                                   bool ranks) const {
  two_samples::QuickResult result =
      paired_ ? two_samples::quick_paired_mean(values_of(sums[0]), plausible_, confidence)
              : two_samples::quick_mean(values_of(sums[0]), values_of(sums[1]), plausible_, confidence);
  if (!ranks) return result;
  double worse = excess_p(sums[0], sums[1], worse_rank);
  double better = excess_p(sums[1], sums[0], better_rank);
  if (paired_) {
    const double z = sums[0][worse_rank] / std::sqrt(std::max(sums[0][better_rank], 1e-300));
    worse = statistics::normal_upper_tail(z);
    better = statistics::normal_upper_tail(-z);
  }
  result.p = std::max(result.p, worse);
  result.improvement_p = std::max(result.improvement_p, better);
  return result;
}

}  // namespace zerocount::comparison

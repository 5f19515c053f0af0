#include "analysis/trials/jerks/laplace_trend.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::jerks {
namespace {

constexpr std::size_t max_enumerated = 7;  // 5040 orders
constexpr std::uint64_t permutations_of_move = 999;
constexpr std::size_t moves_tested_at_once = 512;

// Keys of the random orders: of one move, and of all together.
constexpr random::RandomKey move_key{0x6a65726b, 1};
constexpr random::RandomKey study_key{0x6a65726b, 2};

/// Laplace's statistic ΣT_j of the intervals between jerks, exact in whole samples; T_j is the sum of the
/// first j intervals.
std::int64_t laplace_sum(std::span<const std::int64_t> intervals) {
  std::int64_t sum = 0;
  std::int64_t time = 0;
  for (const std::int64_t interval : intervals) sum += time += interval;
  return sum;
}

/// Puts the intervals into a random order (Fisher and Yates). The order depends only on the stream of random
/// numbers and on `round`, the number of the permutation.
void shuffle(std::vector<std::int64_t>& intervals, const random::RandomStream& stream, std::uint64_t round) {
  for (std::size_t remaining = intervals.size(); remaining > 1; --remaining) {
    const std::uint64_t bits =
        random::random_bits(stream, round, static_cast<std::uint32_t>(remaining)) >> 32U;
    std::swap(intervals[remaining - 1], intervals[static_cast<std::size_t>(bits * remaining >> 32U)]);
  }
}

/// Counts of the orders of a move's intervals whose Laplace statistic is at most, and at least, the observed
/// one.
struct OrderCount {
  std::int64_t orders{0}, small{0}, large{0};

  void add(std::int64_t sum, std::int64_t observed) {
    ++orders;
    small += sum <= observed;
    large += sum >= observed;
  }
  TrendProbability probability() const {
    return {statistics::rate(small, orders), statistics::rate(large, orders)};
  }
};

OrderCount all_orders(std::span<const std::int64_t> intervals, std::int64_t observed) {
  OrderCount count;
  std::vector<std::int64_t> order(intervals.begin(), intervals.end());
  std::sort(order.begin(), order.end());
  do {
    count.add(laplace_sum(order), observed);
  } while (std::next_permutation(order.begin(), order.end()));
  return count;
}

OrderCount random_orders(std::span<const std::int64_t> intervals, std::int64_t observed, std::uint32_t move) {
  OrderCount count;
  count.add(observed, observed);
  std::vector<std::int64_t> order(intervals.begin(), intervals.end());
  for (std::uint64_t round = 0; round < permutations_of_move; ++round) {
    shuffle(order, {move_key, move}, round);
    count.add(laplace_sum(order), observed);
  }
  return count;
}

/// One-sided p-value of the trend of all moves together: the proportion of random orders of the intervals of
/// all moves whose summed statistic is at most the observed one.
/// @param moves [move] intervals, samples
double permuted_p(const std::vector<std::vector<std::int64_t>>& moves) {
  std::int64_t observed = 0;
  for (const std::vector<std::int64_t>& intervals : moves) observed += laplace_sum(intervals);
  const auto as_small = [&](const oneapi::tbb::blocked_range<std::int64_t>& rounds, std::int64_t count) {
    std::vector<std::int64_t> order;
    for (std::int64_t round = rounds.begin(); round < rounds.end(); ++round) {
      std::int64_t sum = 0;
      for (std::size_t move = 0; move < moves.size(); ++move) {
        order = moves[move];
        shuffle(order, {study_key, static_cast<std::uint32_t>(move)}, static_cast<std::uint64_t>(round));
        sum += laplace_sum(order);
      }
      count += sum <= observed;
    }
    return count;
  };
  const std::int64_t count =
      oneapi::tbb::parallel_reduce(oneapi::tbb::blocked_range<std::int64_t>(0, trend_permutations),
                                   std::int64_t{0}, as_small, std::plus<>());
  return statistics::rate(count + 1, trend_permutations + 1);
}

}  // namespace

TrendTerm trend_term(std::span<const std::int64_t> intervals) {
  const auto m = static_cast<double>(intervals.size());
  double total = 0.0;
  for (const std::int64_t interval : intervals) total += static_cast<double>(interval);
  const double mean = total / m;
  double squares = 0.0;
  for (const std::int64_t interval : intervals)
    squares += (static_cast<double>(interval) - mean) * (static_cast<double>(interval) - mean);
  if (intervals.size() < 2) return {std::ssize(intervals), 0.0, 0.0};
  return {std::ssize(intervals), static_cast<double>(laplace_sum(intervals)) - 0.5 * total * (m + 1.0),
          m * (m + 1.0) / 12.0 * squares};
}

double trend_score(const TrendTerm& term) {
  if (!(term.variance > 0.0)) return statistics::unknown;
  return term.excess / std::sqrt(term.variance);
}

TrendProbability trend_probability(std::span<const std::int64_t> intervals, std::uint32_t move) {
  const std::int64_t observed = laplace_sum(intervals);
  return (intervals.size() <= max_enumerated ? all_orders(intervals, observed)
                                             : random_orders(intervals, observed, move))
      .probability();
}

TrendSum::TrendSum(double confidence) : level_(1.0 - confidence) {
  statistics::require_confidence(confidence);
}

void TrendSum::add(std::span<const std::int64_t> intervals) {
  const TrendTerm term = trend_term(intervals);
  const double score = trend_score(term);
  if (std::isnan(score)) return;
  const auto number = static_cast<std::uint32_t>(counted_.moves++);
  excess_ += term.excess;
  variance_ += term.variance;
  scores_ += score;
  intervals_ += term.intervals;
  if (intervals_ <= max_permuted_intervals) {
    kept_.emplace_back(intervals.begin(), intervals.end());
  } else {
    kept_.clear();
  }
  if (term.intervals < min_trend_intervals) return;
  ++counted_.tested;
  untested_.push_back({number, {intervals.begin(), intervals.end()}});
  if (untested_.size() == moves_tested_at_once) test_moves();
}

void TrendSum::test_moves() {
  std::vector<TrendProbability> found(untested_.size());
  oneapi::tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    found[i] = trend_probability(untested_[i].intervals, untested_[i].number);
  });
  for (const TrendProbability& p : found) {
    counted_.slowing += p.slowing <= level_;
    counted_.quickening += p.quickening <= level_;
  }
  untested_.clear();
}

TrendSummary TrendSum::summary() {
  test_moves();
  TrendSummary result = counted_;
  if (result.moves == 0) return result;
  result.summed = excess_ / std::sqrt(variance_);
  result.stouffer = scores_ / std::sqrt(static_cast<double>(result.moves));
  const bool permuted = intervals_ <= max_permuted_intervals;
  result.permutations = permuted ? trend_permutations : 0;
  result.p_slowing = permuted ? permuted_p(kept_) : statistics::normal_upper_tail(-result.summed);
  return result;
}

}  // namespace zerocount::jerks

#include "analysis/measures/point_accumulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/divergence.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount {
namespace {

/// Onsets are whole multiples of the sample time. Their differences carry rounding errors that would make
/// equal intervals differ, in a histogram and in a comparison: to the picosecond they do not.
double rounded_interval(double seconds) {
  return std::round(seconds * 1e12) / 1e12;
}

RateWithBounds rate_with_bounds(std::int64_t successes, std::int64_t trials, double confidence) {
  if (trials == 0) return {};
  return {rate(successes, trials), clopper_pearson(successes, trials, confidence),
          wilson(successes, trials, confidence)};
}

RateWithBounds rate_on_rigs(std::span<const RigTrials> rigs, std::int64_t RigTrials::*hits,
                            double confidence) {
  const ClusteredProportion proportion = clustered_proportion(sums_over_rigs(rigs, hits), confidence);
  return {proportion.value, proportion.korn_graubard, proportion.wilson};
}

/// No limit is known for trials whose number was decided by their outcomes.
auto tolerance_limits(const ClusteredSample& slowest, const StatisticsOptions& options) {
  std::array<ToleranceLimit, std::size(tolerance_contents)> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i].content = tolerance_contents[i];
    if (options.stopped_by_outcomes || slowest.size() == 0) continue;
    limits[i].within = clustered_upper_limit(slowest, limits[i].content, options.confidence);
  }
  return limits;
}

/// Without bounds of the mean, and without limits.
SettlingStatistics settling_statistics(const ClusteredSample& sample, double confidence) {
  const Histogram<double>& times = sample.observed();
  const auto settled = [&](double probability) {
    return clustered_quantile(sample, probability, confidence);
  };
  return {times.size,    sample.size(), mean(times),  smallest(times), largest(times),
          settled(0.05), settled(0.25), settled(0.5), settled(0.75),   settled(0.95)};
}

RandomStream bootstrap_stream(const BootstrapDraws& draws, std::string_view name) {
  return {random_key(draws.seed, name), draws.stream};
}

constexpr ConfidenceInterval not_asked_for{std::numeric_limits<double>::quiet_NaN(),
                                           std::numeric_limits<double>::quiet_NaN()};

void require_move_count(std::size_t moves, std::int64_t trials, std::size_t expected) {
  if (moves > 0 && (trials == 0 || moves == expected)) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("a trial with {} moves; expected {}", moves,
                            trials == 0 ? "at least one" : fmt::format("{} as before", expected)));
}

/// @throws Failure (bad_data) where a judged move stands in an open-loop study, or the reverse.
void require_kind(const MoveOutcome& move, bool open_loop) {
  if (move.outcome == Outcome::nonfinite || (move.outcome == Outcome::open_loop) == open_loop) return;
  throw Failure(ExitCode::bad_data, open_loop ? "a move that was judged; expected a torque level"
                                              : "a move with a torque level; expected one with a target");
}

void count_move(const MoveOutcome& move, MoveCounts& counts) {
  ++(counts.outcomes.*counter_of(move.outcome));
  counts.stable += move.stable;
  counts.arrived += move.arrived;
  counts.broke_away += move.broke_away;
  counts.saturated += move.saturated;
  counts.stopped += move.stopped;
}

std::int64_t sum_of(const std::vector<MoveOutcome>& moves, std::int64_t MoveOutcome::*measure) {
  std::int64_t sum = 0;
  for (const MoveOutcome& move : moves) sum += move.*measure;
  return sum;
}

std::int64_t cluster_of(const MoveKind& kind, std::int64_t trial) {
  return kind.rigs > 0 ? trial % kind.rigs : trial;
}

}  // namespace

PointAccumulator::PointAccumulator(MoveKind kind)
    : kind_(kind),
      settling_times_(kind.rigs),
      final_settling_times_(kind.rigs),
      slowest_times_(kind.rigs),
      final_errors_(kind.rigs) {}

void PointAccumulator::add(const TrialOutcome& trial, std::span<const Jerk> jerks) {
  require_move_count(trial.moves.size(), counted_.trials, counted_.by_move.size());
  add_moves(trial);
  std::size_t next = 0;
  for (std::size_t move = 0; move < trial.moves.size(); ++move) {
    const std::size_t first = next;
    while (next < jerks.size() && jerks[next].move == static_cast<std::int64_t>(move)) ++next;
    add_jerks(trial.moves[move], jerks.subspan(first, next - first));
  }
  if (next != jerks.size()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("jerk {} of a trial is of move {}; expected jerks in order of their moves, 0 to {}", next,
                    jerks[next].move, trial.moves.size() - 1));
  }
  jerk_counts_.add(static_cast<std::int64_t>(jerks.size()));
  jerk_totals_.add(cluster_of(kind_, counted_.trials), static_cast<double>(jerks.size()), 1.0);
  ++counted_.trials;
}

void PointAccumulator::add_moves(const TrialOutcome& trial) {
  const std::vector<MoveOutcome>& moves = trial.moves;
  counted_.by_move.resize(moves.size());
  if (kind_.open_loop) counted_.levels.resize(moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    require_kind(moves[i], kind_.open_loop);
    count_move(moves[i], counted_.by_move[i]);
    add_measures(moves[i]);
    if (kind_.open_loop) counted_.levels[i].add(moves[i]);
  }
  counted_.moves += static_cast<std::int64_t>(moves.size());
  ++(counted_.outcomes.*counter_of(worst_outcome(moves)));
  if (!kind_.open_loop) {
    if (kind_.rigs > 0) add_to_rig(moves);
    add_times(moves);
    add_final_times(moves);
    if (kind_.final_error_known) add_errors(moves);
  }
  counted_.stable += was_stable(moves);
  counted_.arrived += has_arrived(moves);
  counted_.broke_away +=
      std::any_of(moves.begin(), moves.end(), [](const MoveOutcome& m) { return m.broke_away; });
  counted_.saturated +=
      std::any_of(moves.begin(), moves.end(), [](const MoveOutcome& m) { return m.saturated; });
  counted_.stopped += std::any_of(moves.begin(), moves.end(), [](const MoveOutcome& m) { return m.stopped; });
  counted_.phase_changes.add(sum_of(moves, &MoveOutcome::phase_changes));
  counted_.encoder_disagreement.add(sum_of(moves, &MoveOutcome::encoder_disagreement));
}

void PointAccumulator::add_to_rig(const std::vector<MoveOutcome>& moves) {
  const auto number = static_cast<std::size_t>(counted_.trials % kind_.rigs);
  if (number >= rigs_.size()) rigs_.resize(number + 1);
  RigTrials& rig = rigs_[number];
  const auto zero =
      std::count_if(moves.begin(), moves.end(), [](const MoveOutcome& m) { return is_success(m.outcome); });
  ++rig.trials;
  rig.successes += succeeded(moves);
  rig.stable += was_stable(moves);
  rig.moves += std::ssize(moves);
  rig.zero_moves += zero;
}

/// A move that never arrived, or was not run because one before it had diverged, is later than any time.
void PointAccumulator::add_times(const std::vector<MoveOutcome>& moves) {
  values_.clear();
  double sum = 0.0;
  for (const MoveOutcome& move : moves) {
    if (!was_run(move) || !move.arrived) continue;
    values_.push_back(move.settling_time);
    sum += move.settling_time;
  }
  settling_totals_.add(cluster_of(kind_, counted_.trials), sum, static_cast<double>(values_.size()));
  settling_times_.add_trial(counted_.trials, values_, std::ssize(moves));
  const bool all_arrived = values_.size() == moves.size();
  if (all_arrived) {
    values_.assign(1, *std::max_element(values_.begin(), values_.end()));
  } else {
    values_.clear();
  }
  slowest_times_.add_trial(counted_.trials, values_, 1);
}

void PointAccumulator::add_final_times(const std::vector<MoveOutcome>& moves) {
  values_.clear();
  double sum = 0.0;
  for (const MoveOutcome& move : moves) {
    if (!was_run(move) || std::isnan(move.final_settling_time)) continue;
    values_.push_back(move.final_settling_time);
    sum += move.final_settling_time;
  }
  final_settling_totals_.add(cluster_of(kind_, counted_.trials), sum, static_cast<double>(values_.size()));
  final_settling_times_.add_trial(counted_.trials, values_, std::ssize(moves));
}

void PointAccumulator::add_errors(const std::vector<MoveOutcome>& moves) {
  values_.clear();
  for (const MoveOutcome& move : moves) {
    if (!was_run(move) || move.outcome == Outcome::nonfinite) continue;
    values_.push_back(static_cast<double>(std::abs(move.final_error)));
  }
  final_errors_.add_trial(counted_.trials, values_, std::ssize(values_));
}

void PointAccumulator::add_measures(const MoveOutcome& move) {
  if (!was_run(move)) return;
  counted_.true_error.add(std::abs(move.true_error));
  if (move.arrived) counted_.zero_fraction.add(move.zero_fraction);
  if (!std::isnan(move.oscillation_amplitude)) amplitudes_.add(move.oscillation_amplitude);
  if (!std::isnan(move.oscillation_period)) periods_.add(move.oscillation_period);
  if (!kind_.open_loop) counted_.overshoot.add(static_cast<double>(move.overshoot));
  counted_.holding_torque.add(move.holding_torque);
  counted_.creep.add(move.creep);
  counted_.peak_torque.add(move.peak_torque);
  counted_.travel_time.add(move.travel_time);
  counted_.reversal_depth = std::max(counted_.reversal_depth, move.reversal_depth);
}

void PointAccumulator::add_jerks(const MoveOutcome& move, std::span<const Jerk> jerks) {
  if (static_cast<std::int64_t>(jerks.size()) != move.jerk_count) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{} jerks recorded of a move that counted {}", jerks.size(), move.jerk_count));
  }
  intervals_.clear();
  for (std::size_t i = 0; i < jerks.size(); ++i) {
    counted_.jerks_agreeing += jerks[i].direction == sign_of(move.holding_torque);
    one_count_jerks_ += jerks[i].magnitude == 1;
    if (i == 0) continue;
    const double interval = rounded_interval(jerks[i].onset - jerks[i - 1].onset);
    if (!(interval > 0.0)) {
      throw Failure(ExitCode::bad_data,
                    fmt::format("a jerk at {} s after one at {} s; expected jerks in order of onset",
                                jerks[i].onset, jerks[i - 1].onset));
    }
    intervals_.push_back(interval);
    jerk_intervals_.add(interval);
  }
  if (intervals_.size() < 2) return;
  const RankTrend trend = rank_trend(intervals_);
  interval_trend_ += trend;
  ++counted_.jerk_slowing.moves;
  counted_.jerk_slowing.slowing += trend.rising > trend.falling;
  counted_.jerk_slowing.quickening += trend.rising < trend.falling;
}

PointSummary PointAccumulator::statistics(const StatisticsOptions& options) const {
  const double confidence = options.confidence;
  PointSummary result = counted_;
  result.confidence = confidence;
  for (LevelStatistics& level : result.levels) level.confidence = confidence;
  result.judged = kind_.open_loop ? 0 : result.trials;
  if (kind_.rigs > 0 && result.judged > 0) {
    result.success_rate = rate_on_rigs(rigs_, &RigTrials::successes, confidence);
    result.stable_rate = rate_on_rigs(rigs_, &RigTrials::stable, confidence);
    result.rigs = rig_statistics(rigs_, confidence);
    result.claim = success_claim_on_rigs(result.rigs.successes, confidence);
    if (options.stopped_by_outcomes) {
      result.claim = weaker_claim(
          result.claim, success_claim_at_any_time(result.outcomes.zero_count, result.judged, confidence));
      result.rigs.tolerance = {};  // it takes a number of trials that was fixed beforehand
    }
  } else {
    result.success_rate = rate_with_bounds(result.outcomes.zero_count, result.judged, confidence);
    result.stable_rate = rate_with_bounds(result.stable, result.judged, confidence);
    const std::int64_t successes = result.judged > 0 ? result.outcomes.zero_count : 0;
    result.claim = options.stopped_by_outcomes
                       ? success_claim_at_any_time(successes, result.judged, confidence)
                       : success_claim(successes, result.judged, confidence);
  }

  result.settling_time = settling_statistics(settling_times_.sample(), confidence);
  result.settling_time.tolerance = tolerance_limits(slowest_times_.sample(), options);
  result.final_settling_time = settling_statistics(final_settling_times_.sample(), confidence);

  const ClusteredSample errors = final_errors_.sample();
  result.final_error = {errors.size(), mean(errors.observed()), largest(errors.observed()),
                        clustered_quantile(errors, 0.5, confidence),
                        clustered_quantile(errors, 0.95, confidence)};

  result.oscillation = {amplitudes_.size, quantile(amplitudes_, 0.5).value, quantile(periods_, 0.5).value};

  const Histogram<std::int64_t>& jerks = jerk_counts_;
  const std::int64_t jerk_total = total(jerks);
  result.jerk_count = {jerks.size,
                       mean(jerks),
                       standard_deviation(jerks),
                       quantile(jerks, 0.5).value,
                       quantile(jerks, 0.95).value,
                       largest(jerks),
                       jerk_total,
                       not_asked_for};
  if (options.bootstrap && result.judged > 0) {
    result.settling_time.mean_bounds = clustered_mean_bounds(
        settling_totals_, bootstrap_stream(*options.bootstrap, "bootstrap/settling_time.mean"), confidence);
    result.final_settling_time.mean_bounds = clustered_mean_bounds(
        final_settling_totals_, bootstrap_stream(*options.bootstrap, "bootstrap/final_settling_time.mean"),
        confidence);
    result.jerk_count.mean_bounds = clustered_count_bounds(
        jerk_totals_, bootstrap_stream(*options.bootstrap, "bootstrap/jerk_count.mean"), confidence);
  }
  result.jerk_interval = {jerk_intervals_.size, mean(jerk_intervals_), quantile(jerk_intervals_, 0.5).value};
  result.jerk_slowing.proportion = rate(result.jerk_slowing.slowing, result.jerk_slowing.moves);
  result.jerk_slowing.tau = kendall_tau(interval_trend_);
  result.jerk_agreement = rate(result.jerks_agreeing, jerk_total);
  result.jerk_one_count_share = rate(one_count_jerks_, jerk_total);
  return result;
}

}  // namespace zerocount

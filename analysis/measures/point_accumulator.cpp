#include "analysis/measures/point_accumulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/failure/failure.hpp"
#include "core/numerics/sign.hpp"
#include "core/trial/divergence.hpp"

namespace zerocount::measures {
namespace {

/// Rounded to 1 ps: onsets are whole multiples of the sample time, and the rounding errors of their
/// differences would make equal intervals differ.
double rounded_interval(double seconds) {
  return std::round(seconds * 1e12) / 1e12;
}

/// Without limits if the outcomes decided the number of trials: the limits need a fixed number.
auto tolerance_limits(const statistics::ClusteredSample& times, const StatisticsOptions& options) {
  std::array<statistics::ToleranceLimit, std::size(statistics::tolerance_contents)> limits{};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i].content = statistics::tolerance_contents[i];
    if (options.stopped_by_outcomes || times.size() == 0) continue;
    limits[i].within = statistics::clustered_upper_limit(times, limits[i].content, options.confidence);
  }
  return limits;
}

void require_move_count(std::size_t moves, std::int64_t trials, std::size_t expected) {
  if (moves > 0 && (trials == 0 || moves == expected)) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("a trial with {} moves; expected {}", moves,
                            trials == 0 ? "at least one" : fmt::format("{} as before", expected)));
}

/// @throws Failure (bad_data) where a judged move stands in an open-loop study, or the reverse.
void require_kind(const trial::MoveOutcome& move, bool open_loop) {
  if (move.outcome == trial::Outcome::nonfinite || (move.outcome == trial::Outcome::open_loop) == open_loop)
    return;
  throw Failure(ExitCode::bad_data, open_loop ? "a move that was judged; expected a torque level"
                                              : "a move with a torque level; expected one with a target");
}

void add_trials(MeasureAccumulator& measure, std::span<const trial::MoveOutcome> moves,
                std::size_t moves_of_trial) {
  for (std::size_t first = 0; first < moves.size(); first += moves_of_trial) {
    measure.add(moves.subspan(first, moves_of_trial));
  }
}

std::vector<MeasureStatistics> statistics_of(const std::vector<MeasureAccumulator>& measures,
                                             const StatisticsOptions& options) {
  std::vector<MeasureStatistics> statistics(measures.size());
  oneapi::tbb::parallel_for(std::size_t{0}, measures.size(),
                            [&](std::size_t i) { statistics[i] = measures[i].statistics(options); });
  return statistics;
}

}  // namespace

std::int64_t OutcomeCounts::*counter_of(trial::Outcome outcome) {
  switch (outcome) {
    case trial::Outcome::zero_count:
      return &OutcomeCounts::zero_count;
    case trial::Outcome::one_count:
      return &OutcomeCounts::one_count;
    case trial::Outcome::off_target:
      return &OutcomeCounts::off_target;
    case trial::Outcome::oscillating:
      return &OutcomeCounts::oscillating;
    case trial::Outcome::nonfinite:
      return &OutcomeCounts::nonfinite;
    case trial::Outcome::open_loop:
      return &OutcomeCounts::open_loop;
  }
  throw Failure(ExitCode::bad_data,
                fmt::format("a move with outcome {}; expected 0 to 5", static_cast<int>(outcome)));
}

PointAccumulator::PointAccumulator(const MoveKind& kind, const layout::MeasureTable& table)
    : kind_(kind), trial_settling_times_(kind.rigs) {
  counted_.table = &table;
  for (const layout::Measure& measure : table) measures_.emplace_back(measure, measure.point, kind);
}

void PointAccumulator::add(const trial::TrialOutcome& trial, std::span<const trial::Jerk> jerks) {
  add_counts(trial.moves, jerks);
  add_measures(trial.moves, trial.moves.size());
}

void PointAccumulator::add_measures(std::span<const trial::MoveOutcome> moves, std::size_t moves_of_trial) {
  for (MeasureAccumulator& measure : measures_) add_trials(measure, moves, moves_of_trial);
}

void PointAccumulator::add_measures_in_tasks(std::span<const trial::MoveOutcome> moves,
                                             std::size_t moves_of_trial) {
  oneapi::tbb::parallel_for(std::size_t{0}, measures_.size(),
                            [&](std::size_t i) { add_trials(measures_[i], moves, moves_of_trial); });
}

void PointAccumulator::add_counts(std::span<const trial::MoveOutcome> moves,
                                  std::span<const trial::Jerk> jerks) {
  require_move_count(moves.size(), counted_.trials, counted_.by_move.size());
  add_moves(moves);
  std::size_t next = 0;
  for (std::size_t move = 0; move < moves.size(); ++move) {
    const std::size_t first = next;
    while (next < jerks.size() && jerks[next].move == static_cast<std::int64_t>(move)) ++next;
    add_jerks(moves[move], jerks.subspan(first, next - first));
  }
  if (next != jerks.size()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("jerk {} of a trial is of move {}; expected jerks in order of their moves, 0 to {}", next,
                    jerks[next].move, moves.size() - 1));
  }
  jerks_ += std::ssize(jerks);
  ++counted_.trials;
}

void PointAccumulator::add_moves(std::span<const trial::MoveOutcome> moves) {
  counted_.by_move.resize(moves.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    require_kind(moves[i], kind_.open_loop);
    ++(counted_.by_move[i].*counter_of(moves[i].outcome));
    if (kind_.open_loop) add_level(i, moves.subspan(i, 1));
  }
  counted_.moves += std::ssize(moves);
  ++(counted_.outcomes.*counter_of(trial::worst_outcome(moves)));
  if (kind_.open_loop) return;
  if (kind_.rigs > 0) add_to_rig(moves);
  add_trial_settling_time(moves);
}

void PointAccumulator::add_level(std::size_t level, std::span<const trial::MoveOutcome> move) {
  if (level == levels_.size()) {
    counted_.levels.emplace_back().table = counted_.table;
    levels_.emplace_back();
    for (const layout::Measure& measure : *counted_.table)
      levels_[level].emplace_back(measure, measure.level, kind_);
  }
  if (move.front().outcome == trial::Outcome::nonfinite) {
    ++counted_.levels[level].nonfinite;
  } else {
    for (MeasureAccumulator& measure : levels_[level]) measure.add(move);
  }
}

void PointAccumulator::add_to_rig(std::span<const trial::MoveOutcome> moves) {
  const auto number = static_cast<std::size_t>(counted_.trials % kind_.rigs);
  if (number >= rigs_.size()) rigs_.resize(number + 1);
  statistics::RigTrials& rig = rigs_[number];
  const auto zero = std::count_if(moves.begin(), moves.end(),
                                  [](const trial::MoveOutcome& m) { return trial::is_success(m.outcome); });
  ++rig.trials;
  rig.successes += trial::succeeded(moves);
  rig.moves += std::ssize(moves);
  rig.zero_moves += zero;
}

/// The settling time of a trial is that of its slowest move. It is censored if a move did not arrive, or was
/// not run because a move before it diverged.
void PointAccumulator::add_trial_settling_time(std::span<const trial::MoveOutcome> moves) {
  values_.clear();
  if (std::all_of(moves.begin(), moves.end(),
                  [](const trial::MoveOutcome& m) { return trial::was_run(m) && m.arrived; })) {
    double slowest = 0.0;
    for (const trial::MoveOutcome& move : moves) slowest = std::max(slowest, move.settling_time);
    values_.push_back(slowest);
  }
  trial_settling_times_.add_trial(counted_.trials, values_, 1);
}

void PointAccumulator::add_jerks(const trial::MoveOutcome& move, std::span<const trial::Jerk> jerks) {
  if (static_cast<std::int64_t>(jerks.size()) != move.jerk_count) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{} jerks recorded of a move that counted {}", jerks.size(), move.jerk_count));
  }
  values_.clear();
  for (std::size_t i = 0; i < jerks.size(); ++i) {
    counted_.jerks_agreeing += jerks[i].direction == numerics::sign_of(move.holding_torque);
    one_count_jerks_ += jerks[i].magnitude == 1;
    if (i == 0) continue;
    const double interval = rounded_interval(jerks[i].onset - jerks[i - 1].onset);
    if (!(interval > 0.0)) {
      throw Failure(ExitCode::bad_data,
                    fmt::format("a jerk at {} s after one at {} s; expected jerks in order of onset",
                                jerks[i].onset, jerks[i - 1].onset));
    }
    values_.push_back(interval);
    jerk_intervals_.add(interval);
  }
  if (values_.size() < 2) return;
  const statistics::RankTrend trend = statistics::rank_trend(values_);
  interval_trend_ += trend;
  ++counted_.jerk_slowing.moves;
  counted_.jerk_slowing.slowing += trend.rising > trend.falling;
  counted_.jerk_slowing.quickening += trend.rising < trend.falling;
}

statistics::SuccessClaim PointAccumulator::claim(const PointSummary& point,
                                                 const StatisticsOptions& options) const {
  const std::int64_t successes = point.judged > 0 ? point.outcomes.zero_count : 0;
  const auto at_any_time = [&] {
    return statistics::success_claim_at_any_time(successes, point.judged, options.confidence);
  };
  if (kind_.rigs == 0 || point.judged == 0) {
    return options.stopped_by_outcomes
               ? at_any_time()
               : statistics::success_claim(successes, point.judged, options.confidence);
  }
  const statistics::SuccessClaim on_rigs =
      statistics::success_claim_on_rigs(point.rigs.successes, options.confidence);
  return options.stopped_by_outcomes ? statistics::weaker_claim(on_rigs, at_any_time()) : on_rigs;
}

PointSummary PointAccumulator::statistics(const StatisticsOptions& options) const {
  PointSummary result = counted_;
  result.judged = kind_.open_loop ? 0 : result.trials;
  result.measures = statistics_of(measures_, options);
  for (std::size_t i = 0; i < levels_.size(); ++i)
    result.levels[i].measures = statistics_of(levels_[i], options);
  if (kind_.rigs > 0 && result.judged > 0)
    result.rigs = statistics::rig_statistics(rigs_, options.confidence);
  result.claim = claim(result, options);
  if (options.stopped_by_outcomes)
    result.rigs.tolerance = {};  // it takes a number of trials that was fixed beforehand
  result.settles_within = tolerance_limits(trial_settling_times_.sample(), options);
  result.jerk_interval = {jerk_intervals_.size, statistics::mean(jerk_intervals_),
                          statistics::quantile(jerk_intervals_, 0.5).value};
  result.jerk_slowing.proportion = statistics::rate(result.jerk_slowing.slowing, result.jerk_slowing.moves);
  result.jerk_slowing.tau = statistics::kendall_tau(interval_trend_);
  result.jerk_agreement = statistics::rate(result.jerks_agreeing, jerks_);
  result.jerk_one_count_share = statistics::rate(one_count_jerks_, jerks_);
  return result;
}

}  // namespace zerocount::measures

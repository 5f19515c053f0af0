#include "analysis/trials/goal/question.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/clustered_proportion.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/clusters/machine_statistics.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::goal {
namespace {

/// Counts of the trials of the design point. Each trial counts as one move, which is met if the trial
/// succeeds.
measures::MoveCounts successes_of(const measures::PointSummary& point) {
  measures::MoveCounts counts{
      .moves = point.judged, .met = point.outcomes.zero_count, .of_trials = {}, .machines = {}};
  for (const std::int64_t successes : point.machines.successes_of_machines)
    counts.machines.push_back(
        {point.machines.trials_of_machine, point.machines.trials_of_machine, successes});
  if (!counts.machines.empty()) return counts;
  const auto successes = static_cast<double>(counts.met);
  counts.of_trials = {.clusters = counts.moves,
                      .hits = counts.met,
                      .events = counts.moves,
                      .hits_squared = successes,
                      .hits_by_events = successes,
                      .events_squared = static_cast<double>(counts.moves)};
  return counts;
}

/// The goals of all claims of a question, and for each goal the counts of the point's moves.
struct CountedClaims {
  std::vector<study::Goal> goals{};
  std::vector<measures::CellCounts> counts{};

  CountedClaims(const Question& question, const measures::PointSummary& point) {
    for (const JudgedCriterion& part : question.parts) {
      goals.push_back(part.goal.value());
      counts.push_back(point.goals.at(part.number));
    }
  }
};

/// Whether the settling times for each goal were collected at the design point.
bool has_settling_times(const Question& question, const measures::PointSummary& point) {
  return std::ranges::all_of(
      question.parts, [&](const JudgedCriterion& part) { return part.number < point.goal_settling.size(); });
}

}  // namespace

std::string name_of_settling(const study::Goal& goal, std::string_view statistic) {
  return goal.tolerance
             ? layout::name_of_tolerance(
                   study::name_in(goal, fmt::format("tolerance_settling_time{}", statistic)), *goal.tolerance)
             : layout::name_of_band(fmt::format("band_settling_time{}", statistic), goal.band);
}

std::string under_text(const Question& question, std::size_t setting) {
  return study::setting_phrase(question.settings, static_cast<std::int64_t>(setting));
}

Question question_of(const study::Study& study) {
  Question question{.parts = {},
                    .worlds = study.worlds,
                    .stopped = study.stop.has_value(),
                    .settings = study.settings,
                    .of_mass = study::of_closing_mass(study.features)};
  const std::vector<measures::MoveCriterion> criteria = measures::move_criteria_of(study);
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    question.parts.push_back({.number = i, .criterion = criteria[i]});
    if (!study.goals.empty()) question.parts.back().goal = study.goals[i];
  }
  return question;
}

Question only(const Question& question, std::size_t number) {
  Question one = question;
  std::erase_if(one.parts, [number](const JudgedCriterion& part) { return part.number != number; });
  return one;
}

void require_claim(const study::Study& study, std::string_view path, std::string_view others) {
  if (!study.goals.empty()) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: its manifest has no goal; expected one such as goal: {{band: 1, within: "
                            "0.05, moves: 0.99}}{}",
                            path, others));
}

void require_targets(const study::Study& study, std::string_view path) {
  if (!study.open_loop) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: torque levels have no targets, so no move can be judged; expected "
                            "command.targets",
                            path));
}

bool meets(const Question& question, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(
      question.parts, [&](const JudgedCriterion& part) { return measures::all_meet(part.criterion, moves); });
}

double settling_time(const Question& question, std::span<const trial::MoveOutcome> moves) {
  double latest = 0.0;
  for (const trial::MoveOutcome& move : moves) {
    for (const JudgedCriterion& part : question.parts)
      if (measures::asks(part.criterion, move))
        latest = std::max(latest, measures::lateness(measures::settling_time(part.criterion, move)));
  }
  return latest;
}

Badness badness_of(const Question& question, std::span<const trial::MoveOutcome> moves) {
  std::int64_t final_error = 0;
  for (const trial::MoveOutcome& move : moves)
    final_error = std::max(final_error, std::abs(move.final_error));
  const double severity = trial::severity(trial::worst_outcome(moves));
  const auto error = static_cast<double>(final_error);
  const double time = settling_time(question, moves);
  if (!question.goal()) return {severity, error, time, 0.0};
  const auto missed = std::ranges::count_if(moves, [&](const trial::MoveOutcome& move) {
    return !meets(question, {&move, 1});
  });
  return {static_cast<double>(missed), time, severity, error};
}

Verdict verdict_on(const Question& question, const measures::PointSummary& point, std::size_t points) {
  const CountedClaims claims(question, point);
  Verdict verdict = judge_goals(claims.goals, claims.counts, points);
  for (std::size_t goal = 0; goal < question.parts.size(); ++goal) {
    const JudgedCriterion& part = question.parts[goal];
    if (!part.goal->beside_load || part.number >= point.for_the_load.size()) continue;
    const Verdict load = judge_goal(study::for_the_load(*part.goal), point.for_the_load[part.number], points);
    // In its own worst setting, which may be another than the motor's.
    const ClaimVerdict& worst =
        *std::ranges::min_element(load.claims, {}, [](const ClaimVerdict& one) { return one.moves.value; });
    for (ClaimVerdict& claim : verdict.claims) {
      if (claim.goal != goal) continue;
      claim.of_load = worst.moves;
      claim.load_setting = worst.setting;
    }
  }
  if (verdict.claims.size() > 1 && has_settling_times(question, point)) {
    const std::vector<GoalTimes> times = goal_times(question, point);
    for (ClaimVerdict& claim : verdict.claims)
      claim.standing.earliness = -measures::lateness(times_of_claim(times, claim).time_ratio);
  }
  static_cast<ClaimVerdict&>(verdict) = *std::ranges::min_element(verdict.claims, is_worse);
  return verdict;
}

std::vector<Needs> deciding_studies(const Question& question, const measures::PointSummary& point,
                                    std::size_t points) {
  const CountedClaims claims(question, point);
  return deciding_studies(claims.goals, claims.counts, points);
}

Needs needs_of(const Question& question, const measures::PointSummary& point, std::size_t points) {
  const CountedClaims claims(question, point);
  return needs_of(claims.goals, claims.counts, points);
}

measures::MoveCounts counts_of(const Question& question, const measures::PointSummary& point) {
  if (!question.goal()) return successes_of(point);
  const Verdict verdict = verdict_on(question, point);
  return point.goals.at(question.parts[verdict.goal].number).sum({.setting = verdict.setting});
}

std::vector<GoalTimes> goal_times(const Question& question, const measures::PointSummary& point) {
  std::vector<GoalTimes> all;
  for (std::size_t i = 0; i < question.parts.size(); ++i) {
    const JudgedCriterion& part = question.parts[i];
    const bool has_own =
        part.number < point.goal_settling.size() && !point.goal_settling[part.number].empty();
    if (!has_own) {
      const measures::MeasureStatistics& times = measures::named(point, name_of_settling(*part.goal, ""));
      const double within = part.goal->within.time;
      all.push_back({i, 0, &times, within, measures::lateness(times.p95.value) / within});
      continue;
    }
    for (const measures::SettlingTimes& own : point.goal_settling[part.number]) {
      const auto setting = static_cast<std::size_t>(&own - point.goal_settling[part.number].data());
      all.push_back({i, setting, &own.times, own.allowed, own.time_ratio});
    }
  }
  return all;
}

GoalTimes slowest_goal_times(const Question& question, const measures::PointSummary& point) {
  return std::ranges::max(goal_times(question, point), {}, &GoalTimes::time_ratio);
}

const GoalTimes& times_of_claim(const std::vector<GoalTimes>& times, const ClaimVerdict& claim) {
  return *std::ranges::find_if(
      times, [&](const GoalTimes& one) { return one.part == claim.goal && one.setting == claim.setting; });
}

const measures::MeasureStatistics& settling_of(const Question& question,
                                               const measures::PointSummary& point) {
  return question.goal()
             ? *times_of_claim(goal_times(question, point), verdict_on(question, point)).statistics
             : point.of(&trial::MoveOutcome::arrival_time);
}

std::string settling_measure(const Question& question) {
  return question.goal() ? name_of_settling(*question.goal(), "") : "arrival_time";
}

std::vector<std::string> settling_measures(const Question& question) {
  if (!question.goal()) return {settling_measure(question)};
  std::vector<std::string> names;
  for (const JudgedCriterion& part : question.parts) names.push_back(name_of_settling(*part.goal));
  return names;
}

statistics::Quantile measures::MeasureStatistics::*settling_quantile(const Question& question) {
  return question.goal() ? &measures::MeasureStatistics::p95 : &measures::MeasureStatistics::median;
}

std::string settling_statistic(const Question& question) {
  return question.goal() ? name_of_settling(*question.goal(), "_p95") : "arrival_time_median";
}

std::vector<double> merits_of(const Question& question, const measures::PointSummary& point) {
  if (!question.goal()) {
    return {statistics::rate(point.outcomes.zero_count, point.trials),
            -measures::lateness((settling_of(question, point).*settling_quantile(question)).value)};
  }
  const Verdict verdict = verdict_on(question, point);
  double met = 0.0;
  for (std::size_t goal = 0; goal < question.parts.size(); ++goal)
    met += worst_of_goal(verdict, goal).status == Status::met ? 1.0 : 0.0;
  const Standing& worst = verdict.standing;
  return {met,
          static_cast<double>(worst.status),
          worst.bound,
          worst.observed,
          worst.bound_of_moves,
          worst.observed_of_moves,
          -slowest_goal_times(question, point).time_ratio};
}

QuestionRate rate_of(const Question& question, const measures::PointSummary& point, std::size_t points,
                     double confidence) {
  if (!question.goal()) {
    return {point.success_rate().value, bounds_of_chosen(point, points, question.stopped, confidence),
            point.outcomes.zero_count, point.trials};
  }
  const Verdict verdict = verdict_on(question, point, points);
  measures::Cells cells{.setting = verdict.setting};
  if (!verdict.worlds.empty()) {
    const auto known = [](const WorldVerdict& one) {
      return std::isnan(one.moves.value) ? 2.0 : one.moves.value;  // without trials: the last
    };
    cells.world = static_cast<std::size_t>(std::ranges::min_element(verdict.worlds, {}, known) -
                                           verdict.worlds.begin());
  }
  const measures::MoveCounts shown = point.goals[question.parts[verdict.goal].number].sum(cells);
  return {verdict.moves.value, {verdict.moves.low, verdict.moves.high}, shown.met, shown.moves};
}

MachinesWithoutFailure machines_without_failure(const Question& question,
                                                const measures::PointSummary& point) {
  if (!question.goal())
    return {std::llround(point.machines.without_failure * static_cast<double>(point.machines.n)),
            point.machines.n};
  std::vector<bool> without(point.goals.front().sum().machines.size(), true);
  for (const JudgedCriterion& part : question.parts) {
    const measures::MoveCounts counts = point.goals[part.number].sum();
    for (std::size_t machine = 0; machine < without.size(); ++machine)
      without[machine] = without[machine] && counts.machines[machine].met == counts.machines[machine].moves;
  }
  return {std::ranges::count(without, true), std::ssize(without)};
}

std::optional<MachinesWithoutFailure> machines_meeting_all(const Question& question,
                                                           const measures::PointSummary& point) {
  std::vector<std::pair<double, measures::MoveCounts>> claims;  // proportion of moves, of these
  for (const JudgedCriterion& part : question.parts) {
    if (!part.goal || !part.goal->machines) continue;
    const measures::CellCounts& counts = point.goals[part.number];
    for (std::size_t setting = 0; setting < counts.settings(); ++setting)
      claims.emplace_back(part.goal->moves, counts.sum({.setting = setting}));
  }
  if (claims.size() < 2) return std::nullopt;
  MachinesWithoutFailure meeting{0, std::ssize(claims.front().second.machines)};
  for (std::size_t machine = 0; machine < claims.front().second.machines.size(); ++machine) {
    meeting.machines += std::ranges::all_of(claims, [&](const auto& claim) {
      const statistics::MachineMoves& moves = claim.second.machines[machine];
      return statistics::rate(moves.met, moves.moves) >= claim.first;
    });
  }
  return meeting;
}

const BoundedProportion& judged_rate(const Question& question, const WorldVerdict& world) {
  return is_of_machines(question) ? world.machines : world.moves;
}

double confidence_of(const Question& question, double others) {
  return question.goal() ? question.goal()->confidence : others;
}

statistics::SuccessClaim claim_of_chosen(const measures::PointSummary& point, std::size_t points,
                                         bool stopped) {
  const std::int64_t successes = point.claim.trials - point.claim.failures;
  const double confidence = statistics::confidence_of_each(point.claim.confidence, points);
  statistics::SuccessClaim claim =
      stopped ? statistics::success_claim_at_any_time(successes, point.claim.trials, confidence)
              : statistics::success_claim(successes, point.claim.trials, confidence);
  if (point.machines.n > 0) {
    const statistics::SuccessClaim over_machines =
        statistics::success_claim_on_machines(point.machines.successes, confidence);
    claim = stopped ? statistics::weaker_claim(over_machines, claim) : over_machines;
  }
  claim.confidence = point.claim.confidence;
  return claim;
}

statistics::ConfidenceInterval bounds_of_chosen(const measures::PointSummary& point, std::size_t points,
                                                bool stopped, double confidence) {
  const double each = statistics::confidence_of_each(confidence, points);
  const statistics::ConfidenceInterval fixed =
      point.machines.n > 0 ? statistics::clustered_proportion(point.machines.successes, each).korn_graubard
                           : statistics::clopper_pearson(point.outcomes.zero_count, point.judged, each);
  if (!stopped) return fixed;
  const statistics::ConfidenceInterval sequential =
      statistics::confidence_sequence_bounds(point.outcomes.zero_count, point.judged, each);
  if (point.machines.n == 0) return sequential;
  return {std::min(sequential.low, fixed.low), std::max(sequential.high, fixed.high)};
}

}  // namespace zerocount::goal

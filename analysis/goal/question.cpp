#include "analysis/goal/question.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "analysis/goal/success_bounds.hpp"
#include "analysis/statistics/clusters/clustered_proportion.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::goal {
namespace {

constexpr QuestionWords words_of_goal{.subject = "goal",
                                      .title = "Moves in the goal",
                                      .events = "moves",
                                      .meeting = "moves that meet the goal",
                                      .meet = "meet the goal",
                                      .head = "moves in goal",
                                      .rate = "rate of moves in goal",
                                      .hits = "moves in goal",
                                      .settles = "settles in the goal's band",
                                      .failed = "missed the goal",
                                      .succeeded = "met the goal",
                                      .failure = "miss",
                                      .failing = "trials that miss the goal",
                                      .trial_rate = "rate of trials in goal",
                                      .rig_head = "rigs w/o miss",
                                      .rig_meaning = "proportion of rigs all of whose moves meet the goal",
                                      .falls_short = "fall short of the goal by their observed rates"};

constexpr QuestionWords words_of_success{
    .subject = "success",
    .title = "Success",
    .events = "trials",
    .meeting = "trials that end at zero counts",
    .meet = "end at zero counts",
    .head = "zero-count",
    .rate = "success rate",
    .hits = "successes",
    .settles = "arrives",
    .failed = "failed",
    .succeeded = "succeeded",
    .failure = "failure",
    .failing = "failed trials",
    .trial_rate = "success rate",
    .rig_head = "rigs w/o failure",
    .rig_meaning = "proportion of rigs all of whose trials ended at zero error",
    .falls_short = "are shown to succeed less often than the median world"};

/// A time that is never reached is later than any other.
double lateness(double time) {
  return std::isnan(time) ? std::numeric_limits<double>::infinity() : time;
}

/// The trials that succeed, each as one move.
measures::MoveCounts successes_of(const measures::PointSummary& point) {
  measures::MoveCounts counts{
      .moves = point.judged, .met = point.outcomes.zero_count, .of_trials = {}, .rigs = {}};
  for (const std::int64_t successes : point.rigs.successes_of_rigs)
    counts.rigs.push_back({point.rigs.trials_of_rig, point.rigs.trials_of_rig, successes});
  if (!counts.rigs.empty()) return counts;
  const auto successes = static_cast<double>(counts.met);
  counts.of_trials = {.clusters = counts.moves,
                      .hits = counts.met,
                      .events = counts.moves,
                      .hits_squared = successes,
                      .hits_by_events = successes,
                      .events_squared = static_cast<double>(counts.moves)};
  return counts;
}

}  // namespace

Question question_of(const study::Study& study) {
  return {.parts = {{.claim = study.goal, .counted = measures::asked_of_moves(study)}},
          .worlds = study.worlds,
          .stopped = study.stop.has_value()};
}

void require_claim(const std::optional<study::Goal>& claim, std::string_view path, std::string_view others) {
  if (claim) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: its manifest has no goal; expected one such as goal: {{band: 1, within: "
                            "0.05, moves: 0.99}}{}",
                            path, others));
}

void require_targets(const study::Study& study, std::string_view path) {
  if (!study.open_loop) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: torque levels have no targets, so that nothing is asked of a move; expected "
                            "command.targets",
                            path));
}

const QuestionWords& words_of(const Question& question) {
  return question.claim() ? words_of_goal : words_of_success;
}

bool meets(const Question& question, std::span<const trial::MoveOutcome> moves) {
  return std::ranges::all_of(moves, [&](const trial::MoveOutcome& move) {
    return std::ranges::all_of(question.parts,
                               [&](const JudgedPart& part) { return measures::meets(part.counted, move); });
  });
}

double settling_time(const Question& question, std::span<const trial::MoveOutcome> moves) {
  double latest = 0.0;
  for (const trial::MoveOutcome& move : moves) {
    for (const JudgedPart& part : question.parts)
      latest = std::max(latest, lateness(measures::settling_time(part.counted, move)));
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
  if (!question.claim()) return {severity, error, time, 0.0};
  const auto missed = std::ranges::count_if(moves, [&](const trial::MoveOutcome& move) {
    return !meets(question, {&move, 1});
  });
  return {static_cast<double>(missed), time, severity, error};
}

Verdict verdict_on(const Question& question, const measures::MoveCounts& counts, std::size_t points) {
  return judge_goal(question.claim().value(), counts, points);
}

measures::MoveCounts counts_of(const Question& question, const measures::PointSummary& point) {
  return question.claim() ? point.goal.value() : successes_of(point);
}

const measures::MeasureStatistics& settling_of(const Question& question,
                                               const measures::PointSummary& point) {
  return question.claim() ? measures::of_band(point, "band_settling_time", question.claim()->band)
                          : point.of(&trial::MoveOutcome::settling_time);
}

std::string settling_measure(const Question& question) {
  return question.claim() ? layout::name_of_band("band_settling_time", question.claim()->band)
                          : "settling_time";
}

statistics::Quantile measures::MeasureStatistics::*settling_quantile(const Question& question) {
  return question.claim() ? &measures::MeasureStatistics::p95 : &measures::MeasureStatistics::median;
}

std::string settling_statistic(const Question& question) {
  return question.claim() ? layout::name_of_band("band_settling_time_p95", question.claim()->band)
                          : "settling_time_median";
}

std::vector<double> merits_of(const Question& question, const measures::PointSummary& point) {
  std::vector<double> merits;
  if (question.claim()) {
    const Verdict verdict = verdict_on(question, *point.goal);
    if (is_of_machines(question)) merits.push_back(verdict.machines.value);
    merits.push_back(verdict.moves.value);
  } else {
    merits.push_back(statistics::rate(point.outcomes.zero_count, point.trials));
  }
  merits.push_back(-lateness((settling_of(question, point).*settling_quantile(question)).value));
  return merits;
}

QuestionRate rate_of(const Question& question, const measures::PointSummary& point, std::size_t points,
                     double confidence) {
  if (!question.claim()) {
    return {point.success_rate().value, bounds_of_chosen(point, points, question.stopped, confidence),
            point.outcomes.zero_count, point.trials};
  }
  const Verdict verdict = verdict_on(question, *point.goal, points);
  const measures::MoveCounts shown =
      point.goal->worlds > 0
          ? measures::in_worlds(*point.goal)[worst_worlds_first(*question.claim(), verdict).front()]
          : *point.goal;
  return {verdict.moves.value, {verdict.moves.low, verdict.moves.high}, shown.met, shown.moves};
}

RigsWithoutFailure rigs_without_failure(const Question& question, const measures::PointSummary& point) {
  if (!question.claim())
    return {std::llround(point.rigs.without_failure * static_cast<double>(point.rigs.n)), point.rigs.n};
  const auto without = std::ranges::count_if(
      point.goal->rigs, [](const statistics::RigMoves& rig) { return rig.met == rig.moves; });
  return {without, std::ssize(point.goal->rigs)};
}

const BoundedProportion& judged_rate(const Question& question, const WorldVerdict& world) {
  return is_of_machines(question) ? world.machines : world.moves;
}

std::string_view judged_head(const Question& question) {
  return is_of_machines(question) ? "machines in goal" : words_of(question).head;
}

std::string_view judged_meeting(const Question& question) {
  return is_of_machines(question) ? "machines that meet the goal" : words_of(question).meeting;
}

double confidence_of(const Question& question, double others) {
  return question.claim() ? question.claim()->confidence : others;
}

}  // namespace zerocount::goal

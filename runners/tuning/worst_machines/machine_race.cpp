#include "runners/tuning/worst_machines/machine_race.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "analysis/measures/goal_counts.hpp"
#include "experiments/study/plan.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::size_t stages = stage_trials.size();
constexpr std::size_t race_part = 4;  // one of so many goes on to the next stage
constexpr std::int64_t raced_at_once = 64;

/// Runs the trials of a stage.
void simulate(std::vector<BoxPoint>& points, std::size_t stage, const MachineBox& box,
              const MachineFailures& failures, const trials::Effort& effort) {
  const std::int64_t from = stage == 0 ? 0 : stage_trials[stage - 1];
  const auto trials = static_cast<std::size_t>(stage_trials[stage] - from);
  for (BoxPoint& point : points)
    point.results.push_back(stage == 0 ? ClaimResult{} : ClaimResult(point.results.back()));
  const std::size_t size = (raced_at_once + trials - 1) / trials;
  const auto points_of = [&](std::size_t block) {
    return std::span(points).subspan(block * size, std::min(size, points.size() - block * size));
  };
  const auto draw = [&](std::size_t block) {
    std::vector<trial::TrialParameters> drawn;
    for (const BoxPoint& point : points_of(block)) {
      for (std::int64_t i = from; i < stage_trials[stage]; ++i)
        drawn.push_back(box.trial_of(point, box.study().trials + i));
    }
    return drawn;
  };
  trials::run({static_cast<std::int64_t>(points.size() * trials), (points.size() + size - 1) / size, draw},
              effort, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
                for (BoxPoint& point : points_of(block)) {
                  failures.add_to(point.results.back(), outcomes.first(trials));
                  outcomes = outcomes.subspan(trials);
                }
              });
}

/// The worst first.
void sort_by(std::vector<BoxPoint>& points, std::size_t stage, const MachineFailures& failures) {
  std::ranges::stable_sort(points, [&](const BoxPoint& a, const BoxPoint& b) {
    return failures.is_worse(a.results[stage], b.results[stage]);
  });
}

/// A time beyond any that matters, s: ten times that of the goal, or the hold of a move. Of several goals as
/// a proportion of what each allows.
double late_time(const study::Study& study, std::int64_t point) {
  if (study.goals.size() > 1) return 10.0;
  if (study::first_goal(study)) return study::first_goal(study)->within * 10.0;
  return study::study_trial(study, point, 0).parameters.command.hold;
}

/// Sum of the criterion's values, where one that is never reached counts as `late`.
double lateness(const ClaimResult& unit, double late) {
  double sum = 0.0;
  for (const double value : unit.values) sum += std::min(value, late);
  return sum;
}

/// The smaller, the worse: proportion of the moves that meet the goal, and minus the latest time.
std::pair<double, double> merit_of(const ClaimResult& result) {
  return {met_proportion(result), result.values.empty() ? 0.0 : -std::ranges::max(result.values)};
}

}  // namespace

std::size_t worst_claim(const UnitResult& unit) {
  return static_cast<std::size_t>(std::ranges::min_element(unit.claims, {}, merit_of) - unit.claims.begin());
}

const ClaimResult& worst_result(const UnitResult& unit) {
  return unit.claims[worst_claim(unit)];
}

std::size_t worst_unit(std::span<const UnitResult> units) {
  const auto merit = [](const UnitResult& unit) { return merit_of(worst_result(unit)); };
  return static_cast<std::size_t>(std::ranges::min_element(units, {}, merit) - units.begin());
}

MachineFailures::MachineFailures(const study::Study& study, std::int64_t point)
    : event_(measures::missed_question(study)), late_(late_time(study, point)) {}

void MachineFailures::add_to(ClaimResult& result, std::span<const trial::TrialOutcome> outcomes) const {
  for (const trial::TrialOutcome& outcome : outcomes) {
    for (const trial::MoveOutcome& move : outcome.moves) {
      if (!measures::is_asked(event_, move)) continue;
      const double score = measures::score_of(measures::MoveScore::event, event_, move);
      ++result.moves;
      result.met += measures::happens(event_, move) ? 0 : 1;
      result.values.push_back(std::isnan(score) ? std::numeric_limits<double>::max() : score);
    }
  }
}

bool MachineFailures::is_worse(const ClaimResult& a, const ClaimResult& b) const {
  if (met_proportion(a) != met_proportion(b)) return met_proportion(a) < met_proportion(b);
  return lateness(a, late_) > lateness(b, late_);
}

void race(std::vector<BoxPoint>& points, const MachineBox& box, const MachineFailures& failures,
          const trials::Effort& effort) {
  const auto newcomers = std::stable_partition(
      points.begin(), points.end(), [](const BoxPoint& point) { return point.results.size() == stages; });
  std::vector<BoxPoint> running(newcomers, points.end());
  points.erase(newcomers, points.end());
  for (std::size_t stage = 0; stage < stages; ++stage) {
    simulate(running, stage, box, failures, effort);
    sort_by(running, stage, failures);
    const std::size_t on = std::max((running.size() + race_part - 1) / race_part, survivors / 2);
    if (stage + 1 == stages) break;
    if (running.size() > on) running.resize(on);
    if (points.size() < survivors) continue;
    std::erase_if(running, [&](const BoxPoint& point) {
      return !failures.is_worse(point.results[stage], points.back().results[stage]);
    });
  }
  std::ranges::move(running, std::back_inserter(points));
  sort_by(points, stages - 1, failures);
  if (points.size() > survivors) points.resize(survivors);
}

}  // namespace zerocount::tuning

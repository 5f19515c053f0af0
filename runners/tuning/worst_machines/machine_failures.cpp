#include "runners/tuning/worst_machines/machine_failures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/measures/goal_counts.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::tuning {
namespace {

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

}  // namespace

double latest(const ClaimResult& result) {
  return result.values.empty() ? 0.0 : *std::ranges::max_element(result.values);
}

std::size_t worst_claim(const UnitResult& unit) {
  const auto worst = std::ranges::min_element(unit.claims, [](const ClaimResult& a, const ClaimResult& b) {
    return met_proportion(a) != met_proportion(b) ? met_proportion(a) < met_proportion(b)
                                                  : latest(a) > latest(b);
  });
  return static_cast<std::size_t>(worst - unit.claims.begin());
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

}  // namespace zerocount::tuning

#pragma once

#include <any>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/summary/cells_of_point.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/behaviour.hpp"
#include "runners/tuning/race/tried_points.hpp"
#include "runners/tuning/search/study_search.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/units/loop_examiner.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

namespace zerocount::tuning {

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;               ///< its confidence allows for all attempts
  std::optional<goal::Needs> needs{};  ///< that would decide an undecided one
  int attempts{1};                     ///< candidates or sizes that were proven, this one included
  /// Each goal under each condition, with bounds that allow for all attempts.
  std::vector<summary::CellOfPoint> claims{};
};

/// The result of tuning.
struct TuneAnswer {
  goal::Status status{goal::Status::undecided};
  std::vector<study::FreeParameter> free;
  Values gains;                            ///< empty if no candidate keeps the margins
  std::optional<SmallestMargins> margins;  ///< of the gains
  std::optional<double> lowest_mode;       ///< of a load, that the loops bear (LoopExaminer::lowest_mode), Hz
  bool blind{false};                       ///< the loop has no transfer function: no margins
  std::optional<NearestPoint> nearest;     ///< where no candidate keeps them
  std::string refusal{};                   ///< why no point at all was allowed; empty if any was
  std::optional<Proof> proof;
  double criterion{0.0};  ///< by the proof
  /// Quantile study::Goal::moves of the criterion's values of the worst goal, under its worst condition.
  double late_limit{0.0};
  std::vector<summary::MoveBehaviour>
      behaviour;                      ///< of the proof's moves; before the proof of the search's machines
  std::vector<Refusal> refusals;      ///< what an engineer would refuse of it
  std::vector<std::string> at_edges;  ///< free parameters at an end of their range, "controller.ki = 5000"
  std::optional<WorstMachine> worst;  ///< of the proof
  std::vector<TriedPoint> tried;      ///< by the search
  std::vector<TriedPoint> frontier;   ///< between success and speed, by the search
  std::int64_t examined{0};           ///< points whose margins were examined
  std::int64_t points{0};             ///< that were simulated
  std::int64_t trials{0};             ///< of the search, and of those for other controls
  bool converged{false};
  MissedSearch missed{};               ///< decides the status of a goal that the proof misses
  std::vector<std::string> obstacles;  ///< what keeps the tuned axis from a goal that is not met, in theory
  std::vector<std::any> extras;        ///< what each has found: see extra()
  double seconds{0.0};
  TuneBudget budget{};
  std::int64_t spent_trials{0};               ///< of all: search, proof, and what follows
  std::vector<std::string> left_out;          ///< parts of the answer for which the budget was not enough
  std::vector<std::string_view> left_extras;  ///< names of the extras among them
  bool interrupted{false};  ///< after the proof: the extras that are left out wait for the same command
  std::optional<double>
      default_seconds{};  ///< that the search may take without a budget, as measured here, s

  bool is_met() const { return status == goal::Status::met; }

  /// What the extra of this type has found; null if it was not made.
  template <class Found>
  const Found* extra() const {
    for (const std::any& one : extras) {
      if (const auto* const found = std::any_cast<Found>(&one)) return found;
    }
    return nullptr;
  }
};

}  // namespace zerocount::tuning

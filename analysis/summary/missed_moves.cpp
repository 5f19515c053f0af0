#include "analysis/summary/missed_moves.hpp"

#include <fmt/format.h>

#include "analysis/measures/goal_counts.hpp"
#include "analysis/measures/trial_value.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {

std::optional<SaturatedMoves> saturated_moves(const std::filesystem::path& path, const study::Study& study,
                                              const JudgedClaim& claim) {
  if (layout::has_sums(study.retention)) return {};
  const reading::AllTrialsFile all(path);
  const reading::AllTrialsFile file = all.under_condition(static_cast<std::int64_t>(claim.condition));
  const measures::CountedGoal goal = measures::asked_of_moves(study)[claim.goal];
  const std::int64_t trials = file.header().trials;
  SaturatedMoves counts;
  measures::visit_trials(file, {claim.point * trials, trials}, [&](std::int64_t, const auto& moves) {
    for (const trial::MoveOutcome& move : moves) {
      if (!measures::asks(goal, move)) continue;
      const bool met = measures::meets(goal, move);
      ++(met ? counts.met : counts.missed);
      if (move.saturated) ++(met ? counts.met_saturated : counts.missed_saturated);
    }
  });
  return counts;
}

std::string saturation_sentence(const SaturatedMoves& moves) {
  constexpr double most = 0.5;
  constexpr double more = 0.1;  // of the moves: both kinds saturate alike where long moves accelerate
  if (moves.missed == 0 || moves.of_missed() < most) return "";
  if (moves.met > 0 && moves.of_missed() - moves.of_met() < more) return "";
  const std::string others =
      moves.met > 0 ? fmt::format(" (of the {} others {})", moves.met, moves.met_saturated) : "";
  return fmt::format(
      "  of the {} moves that miss the goal {} saturate{}: the converter clips the torque that the "
      "controller "
      "wants, and its range may be the cause\n",
      moves.missed, moves.missed_saturated, others);
}

}  // namespace zerocount::summary

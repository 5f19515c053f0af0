#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/statistics/clusters/machine_proportion.hpp"

namespace zerocount::goal {

/// "after 0.05 s", "0.25 s after the profile". @param time with its unit
std::string after_text(const study::TimeLimit& limit, const std::string& time);

/// " of the load", the mass of two that a goal speaks of.
std::string of_mass(const study::Goal& goal);

/// "|error| ≤ 1 count for good after 0.05 s in at least 99 % of the moves of at least 99 % of machines, with
/// 95 % confidence".
std::string goal_sentence(const study::Goal& goal);

/// goal_sentence() of the goal, or of each of several.
std::string claim_sentence(const Question& question);

/// "the goal: |error| ≤ 1 count …", "success: all moves of a trial end at zero counts".
std::string question_sentence(const Question& question);

/// The readings of the proportions, a line each: of all moves of all machines; with machines, of machines
/// that meet the goal in Goal::moves of their moves, and of machines without a miss.
std::string readings_text(const study::Goal& goal, const measures::MoveCounts& counts,
                          const ClaimVerdict& verdict);

/// The readings of the goal, or of each of several with its name and verdict. @param verdict on the point
std::string goals_text(const Question& question, const measures::PointSummary& point, const Verdict& verdict);

/// What a move does that does not meet the question: "misses the goal: |error| ≤ 1 count for good after 0.05
/// s", "does not end at zero counts".
std::string missing_text(const Question& question);

/// Predicate of the moves of a trial that succeeds: "meet the goal", "end at zero counts".
std::string doing_text(const Question& question);

/// How the moves of a trial end: "2 of 3 moves meet the goal", or by the worst of them "it ends at zero
/// counts".
std::string ending_text(const Question& question, std::span<const trial::MoveOutcome> moves);

/// "40 moves in 10 trials cannot show 99 % of one machine: 299 trials without a miss are needed; …": what the
/// moves of one machine lack, a line. Empty where a machine without a miss is shown to meet the goal, where
/// the verdict is decided, and where the goal is not about machines. @param study of the moves that are asked
std::string one_machine_text(const study::Goal& goal, const statistics::MachineStudy& study,
                             const ClaimVerdict& verdict);

/// "About 300 machines with 100 trials each decide it with a probability of 90 %, …", or that no study does.
/// @param on_machines whether trials share machines
std::string needs_sentence(const study::Goal& goal, const Needs& needs, bool on_machines);

/// "met", "missed", "undecided": the words of text_of().
std::vector<std::string> status_words();

/// A proportion with its bounds.
inline document::Bounded bounded(const BoundedProportion& proportion) {
  return {proportion.value, proportion.low, proportion.high};
}

/// Machines and trials; for data only, because needs_sentence() says them.
document::Description<Needs> needs_description();
/// The moves of the load that meet a goal of the motor (ClaimVerdict::of_load).
document::Description<BoundedProportion> load_description();

/// Needs that a study of practicable size has; nothing where none is.
const Needs* practicable(const std::optional<Needs>& needs);

}  // namespace zerocount::goal

#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/statistics/clusters/machine_proportion.hpp"

namespace zerocount::goal {

/// "after 0.05 s", "0.25 s after the profile". @param time text of the time with its unit
std::string after_text(const study::TimeLimit& limit, const std::string& time);

/// " of the load" or " of the motor": the mass that a goal names on an axis with two masses. With
/// Goal::of_either: " of the mass whose encoder closes the loop". Empty without a mass.
std::string of_mass(const study::Goal& goal);

/// "|error| ≤ 1 count for good after 0.05 s in at least 99 % of the moves of at least 99 % of machines, with
/// 95 % confidence".
std::string goal_sentence(const study::Goal& goal);

/// goal_sentence() of each goal of the question.
std::string claim_sentence(const Question& question);

/// "the goal: |error| ≤ 1 count …", "success: all moves of a trial end at zero counts".
std::string question_sentence(const Question& question);

/// The proportions behind a verdict with their bounds, one line each: the moves that meet the goal; with
/// machines also the machines that meet it in Goal::moves of their moves, and the machines without a miss.
std::string readings_text(const study::Goal& goal, const measures::MoveCounts& counts,
                          const ClaimVerdict& verdict);

/// readings_text() of the goal. If the question has several goals: of each goal, with its name and verdict.
/// @param verdict verdict on the point
std::string goals_text(const Question& question, const measures::PointSummary& point, const Verdict& verdict);

/// Predicate of a move that does not meet the question: "misses the goal: |error| ≤ 1 count for good after
/// 0.05 s", "does not end at zero counts".
std::string missing_text(const Question& question);

/// Predicate of the moves of a trial that succeeds: "meet the goal", "end at zero counts".
std::string doing_text(const Question& question);

/// How the moves of a trial end: "2 of 3 moves meet the goal", or the ending of its worst move: "it ends at
/// zero counts".
std::string ending_text(const Question& question, std::span<const trial::MoveOutcome> moves);

/// One line that says why the moves of one machine are too few: "40 moves in 10 trials cannot show 99 % of
/// one machine: 299 trials without a miss are needed; …". Empty if a machine without a miss is shown to meet
/// the goal, if the verdict is decided, and if the goal is not about machines. @param study machines, trials
/// and moves that the goal judges
std::string one_machine_text(const study::Goal& goal, const statistics::MachineStudy& study,
                             const ClaimVerdict& verdict);

/// "About 300 machines with 100 trials each decide it with a probability of 90 %, …", or a sentence that no
/// study decides it.
/// @param on_machines whether trials share machines
std::string needs_sentence(const study::Goal& goal, const Needs& needs, bool on_machines);

/// All texts of text_of(): "met", "missed", "undecided".
std::vector<std::string> status_words();

/// A proportion with its bounds.
inline document::Bounded bounded(const BoundedProportion& proportion) {
  return {proportion.value, proportion.low, proportion.high};
}

/// The items of Needs, in data only: people read needs_sentence().
document::Description<Needs> needs_description();
/// The item of the moves in which the load meets a goal of the motor (ClaimVerdict::of_load).
document::Description<BoundedProportion> load_description();

/// The needs if a study of practicable size decides the goal (Needs::trials > 0); otherwise null.
const Needs* practicable(const std::optional<Needs>& needs);

}  // namespace zerocount::goal

#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "analysis/trials/goal/question.hpp"

namespace zerocount::goal {

/// Text of the time within which a goal must be met: "after 0.05 s", "0.25 s after the profile".
/// @param time text of the time with its unit
std::string after_text(const study::TimeLimit& limit, const std::string& time);

/// Text that names the mass whose error a goal judges on an axis with two masses: " of the load" or " of the
/// motor". With Goal::of_either: " of the mass whose encoder closes the loop". Empty on an axis with one
/// mass.
std::string of_mass(const study::Goal& goal);

/// The goal in words: "|error| ≤ 1 count for good after 0.05 s in at least 99 % of the moves of at least 99 %
/// of machines, with 95 % confidence".
std::string goal_sentence(const study::Goal& goal);

/// The goals of the question in words: goal_sentence() of each goal.
std::string claim_sentence(const Question& question);

/// The question in words: "the goal: |error| ≤ 1 count …", or without a goal "success: all moves of a trial
/// end at zero counts".
std::string question_sentence(const Question& question);

/// The proportions behind a verdict with their bounds, one line each: the moves that meet the goal; with
/// machines also the machines that meet it in Goal::moves of their moves, and the machines without a miss.
std::string readings_text(const study::Goal& goal, const measures::MoveCounts& counts,
                          const ClaimVerdict& verdict);

/// The proportions behind the verdict on a design point, with their bounds: readings_text() of the goal. If
/// the question has several goals: of each goal, with its name and verdict.
/// @param verdict verdict on the point
std::string goals_text(const Question& question, const measures::PointSummary& point, const Verdict& verdict);

/// Predicate for a move that does not meet the question: "misses the goal: |error| ≤ 1 count for good after
/// 0.05 s", or without a goal "does not end at zero counts".
std::string missing_text(const Question& question);

/// Predicate for the moves of a trial that succeeds: "meet the goal", or without a goal "end at zero counts".
std::string doing_text(const Question& question);

/// Text that says how the moves of a trial end: "2 of 3 moves meet the goal", or without a goal the ending of
/// its worst move: "it ends at zero counts".
std::string ending_text(const Question& question, std::span<const trial::MoveOutcome> moves);

/// One line that says why the moves of one machine are too few: "40 moves in 10 trials cannot show 99 % of
/// one machine: 299 trials without a miss are needed; …". Empty if a machine without a miss is shown to meet
/// the goal, if the verdict is decided, and if the goal is not about machines.
/// @param study machines, trials and moves that the goal judges
std::string one_machine_text(const study::Goal& goal, const statistics::MachineStudy& study,
                             const ClaimVerdict& verdict);

/// Sentence on the study size that decides the goal: "About 300 machines with 100 trials each decide it with
/// a probability of 90 %, …", or that no study decides it.
/// @param on_machines whether trials share machines
std::string needs_sentence(const study::Goal& goal, const Needs& needs, bool on_machines);

/// All texts for a Status, in the order of the enumerators: "met", "missed", "undecided".
std::vector<std::string> status_words();

/// Converts a proportion with its bounds to the content of an item of an answer.
inline document::Bounded bounded(const BoundedProportion& proportion) {
  return {proportion.value, proportion.low, proportion.high};
}

/// Description of Needs (the study size that decides a goal), for JSON and CSV only: people read
/// needs_sentence().
document::Description<Needs> needs_description();
/// Description of the proportion of moves in which the load meets a goal of the motor
/// (ClaimVerdict::of_load).
document::Description<BoundedProportion> load_description();

/// The study size that decides the goal, if it is practicable (Needs::trials > 0); otherwise null.
const Needs* practicable(const std::optional<Needs>& needs);

}  // namespace zerocount::goal

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/acceptance/agreement.hpp"
#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"

/// Machines that were built, beside the study that they were built after.
namespace zerocount::acceptance {

enum class Status {
  accepted,  ///< every goal is shown to be met, and none is met less often than predicted
  rejected,  ///< a goal is shown to be missed, or is met less often than predicted
  undecided  ///< neither
};

/// The machines that a goal is judged for.
enum class Judged {
  all_machines,   ///< all of which the measured ones are a sample: the goal's claim (goal_verdict.hpp)
  these_machines  ///< the measured ones alone
};

/// One goal: what was predicted, and what was measured.
struct Claim {
  study::Goal goal{};
  goal::ClaimVerdict predicted{};  ///< on the simulated machines
  goal::ClaimVerdict measured{};   ///< on all machines of which the measured ones are a sample
  std::int64_t moves{0};           ///< measured, of all machines
  std::int64_t met{0};
  /// Of all moves of the measured machines, each one-sided with the confidence of the goal.
  goal::BoundedProportion rate{};
  goal::Status status{goal::Status::undecided};  ///< of the goal, for the machines that are judged
  double significance{0.05};        ///< of a difference from the prediction of one goal (Bonferroni)
  bool is_below_prediction{false};  ///< significantly fewer moves meet the goal than predicted
  Agreement agreement{};
  /// Worlds of the study that the machines are like; the prediction is that of the one that they are most
  /// like, with the intervals of all. Null: it has none.
  std::optional<std::int64_t> like_worlds{};
};

/// The moves of one machine, by goal.
struct MeasuredMachine {
  std::string name;
  std::vector<std::int64_t> moves{};  ///< [goal] that the goal is about
  std::vector<std::int64_t> met{};    ///< [goal] of these, that meet it
};

/// A value of ISO 230-2 by the encoder, counts: of the simulated machines, and of the measured ones.
struct StandardValue {
  std::string_view name;    ///< "repeatability"
  std::string_view symbol;  ///< of the standard
  double median{0.0};       ///< of the simulated runs of the test
  double low{0.0};          ///< 95 % of them lie between these
  double high{0.0};
  std::vector<double> measured{};  ///< [run] of all machines; NaN where it is not defined
  std::int64_t within{0};          ///< measured runs between `low` and `high`
};

struct Acceptance {
  std::string study{};  ///< name of the file
  std::string point{};  ///< label of the design point
  std::vector<Claim> claims{};
  std::vector<MeasuredMachine> machines{};
  Judged judged{Judged::all_machines};
  /// Machines with which the goals would be decided for all machines; 0: none of up to 10⁵, or they are.
  std::int64_t needed_machines{0};
  std::int64_t simulated{0};                     ///< machines
  std::int64_t worlds{0};                        ///< of the study; 0: none
  std::vector<StandardValue> standard_values{};  ///< of a study with a sequence, where the logs tell them
  /// Effects that the study is without, which its manifest does not name.
  std::vector<std::string> assumed{};
};

Status status_of(const Claim& claim);
/// Of all claims: rejected before undecided before accepted.
Status status_of(const Acceptance& acceptance);
/// success for accepted, regression for rejected, inconclusive.
ExitCode exit_code_of(Status status);

/// Judges the machines whose logs these are by the goals of the study, and compares them with its machines at
/// the point, its rigs. Machines as predicted are found below the prediction of any goal with a probability
/// of 5 % at most.
/// @param file of one condition, with goals
///
/// For these machines alone, a goal is about the moves of all of them, or about `machines` of them: each is
/// judged by the bounds of its own moves, with the confidence 1 − (1 − γ)/m of m machines.
///
/// A goal `on` some moves is judged by the rows that the column `move` of a log says are of these. Machines
/// that live in one of the worlds of a study differ from it where they differ from each of them: the largest
/// p-value counts.
/// @throws Failure: bad_input for a study without rigs, for a log without a measure that a goal asks for, or
/// with it in a unit of another dimension than the study has, and for one that does not number its moves
/// where a goal asks for some; bad_data for a log without moves
Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs, Judged judged = Judged::all_machines);

/// The values of the axis, where the study has a sequence of moves and each log the columns `final_error` and
/// `move`; empty otherwise. A run of the test is as many rows with the numbers 0 to the last one in this
/// order; other rows are left out.
std::vector<StandardValue> standard_values(const reading::AllTrialsFile& file, std::int64_t point,
                                           std::span<const monitor::MoveLog> logs);

document::AnswerDescription<Acceptance> acceptance_answer();

}  // namespace zerocount::acceptance

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/machine/monitor/move_log.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "results/reading/all_trials_file.hpp"

/// Acceptance of built machines: compares their measured moves with the goals and predictions of the study.
namespace zerocount::acceptance {

enum class Status {
  /// Every goal is shown to be met, and no goal is met significantly less often than the simulation
  /// predicted.
  accepted,
  /// A goal is shown to be missed, or is met significantly less often than the simulation predicted.
  rejected,
  undecided  ///< The measured moves do not suffice to accept or to reject.
};

/// The machines about which the acceptance makes its statement.
enum class Judged {
  /// The population from which the measured machines are a sample, as in the goal's claim (goal_verdict.hpp).
  all_machines,
  these_machines  ///< The measured machines alone, without a statement about other machines.
};

/// Result of the test of whether the measured machines agree with the simulated ones in the proportion of
/// moves that meet a goal.
struct Agreement {
  /// Number of moves of each machine that are compared: the smallest number of moves that any machine has.
  std::int64_t moves{0};
  /// Number of moves that meet the goal among the first `moves` moves of each measured machine, summed over
  /// these machines.
  std::int64_t met{0};
  /// Two-sided p-value of the hypothesis that the measured machines are from the population of the simulated
  /// ones; small if they differ.
  double p{1.0};
  /// Smallest p-value that the test can give with these numbers of machines. If it exceeds the significance
  /// level, the test cannot show a difference.
  double lowest_p{1.0};
  /// True if the goal is met by a smaller proportion of measured moves than of simulated moves.
  bool is_lower{false};
  /// Prediction interval (95 %) of the proportion of moves that meet the goal, for as many simulated machines
  /// with as many moves.
  statistics::ConfidenceInterval predicted{0.0, 1.0};
};

/// One goal of the study, with its prediction from the simulated machines and its result on the measured
/// machines.
struct AcceptedGoal {
  study::Goal goal{};
  goal::ClaimVerdict predicted{};  ///< Verdict on the goal from the simulated machines.
  /// Verdict on the goal, from the measured moves, for the population from which the measured machines are a
  /// sample.
  goal::ClaimVerdict measured{};
  std::int64_t moves{0};  ///< Number of measured moves that the goal judges, summed over all machines.
  std::int64_t met{0};
  /// Proportion of the measured machines' moves that meet the goal, with one-sided bounds, each with the
  /// confidence of the goal.
  goal::BoundedProportion rate{};
  /// Status of the goal (met, missed or undecided) for the machines in Acceptance::judged.
  goal::Status status{goal::Status::undecided};
  /// Significance level for the comparison of the measured moves with the prediction of this goal: 0.05
  /// divided by the number of goals (Bonferroni). They differ if Agreement::p is at most this level.
  double significance{0.05};
  bool is_below_prediction{false};  ///< True if significantly fewer moves meet the goal than predicted.
  Agreement agreement{};
  /// Number of worlds of the study with which the measured machines agree. A world is one draw of what all
  /// machines share. The prediction is that of the world most like the machines, and the predicted interval
  /// spans the intervals of all worlds. Null if the study has no worlds.
  std::optional<std::int64_t> like_worlds{};
};

/// Numbers of moves of one measured machine, by goal.
struct MeasuredMachine {
  std::string name;
  std::vector<std::int64_t> moves{};  ///< [goal] Number of moves of the machine that the goal judges.
  std::vector<std::int64_t> met{};    ///< [goal] Number of the machine's judged moves that meet the goal.
};

/// A quantity of ISO 230-2, such as the repeatability, computed from encoder counts, for the simulated and
/// the measured machines.
struct StandardValue {
  std::string_view name;    ///< Name of the quantity, such as "repeatability".
  std::string_view symbol;  ///< Symbol of the quantity in ISO 230-2, such as "R".
  double median{0.0};       ///< Median over the simulated runs of the test, counts.
  /// Lower end of the range that contains the central 95 % of the simulated runs, counts.
  double low{0.0};
  double high{0.0};  ///< Upper end of the range that contains the central 95 % of the simulated runs, counts.
  /// [run] Value of each measured run of the test, of all machines, counts; NaN if the value is not defined.
  std::vector<double> measured{};
  std::int64_t within{0};  ///< Number of measured runs whose value is between `low` and `high`.
};

struct Acceptance {
  /// Name of the results file of the study, with whose simulated machines the measured ones are compared.
  std::string study{};
  std::string point{};  ///< Label of the design point with which the machines are compared.
  std::vector<AcceptedGoal> claims{};
  std::vector<MeasuredMachine> machines{};
  Judged judged{Judged::all_machines};
  /// Number of measured machines with which the goals would be decided for the population of machines. 0 if
  /// they are decided already, or if no number up to 10⁵ suffices.
  std::int64_t needed_machines{0};
  std::int64_t simulated{0};  ///< Number of simulated machines.
  /// Number of worlds in the study (draws of what all machines share); 0 if it has none.
  std::int64_t worlds{0};
  /// Quantities of ISO 230-2 of the simulated and the measured machines. Empty if the study has no sequence
  /// of moves, if a log lacks a column that they need, or if the logs or the study have no run with these
  /// values.
  std::vector<StandardValue> standard_values{};
  /// Column that a log lacks for the values of ISO 230-2: "a.csv has no column final_error". Empty if no
  /// column is lacking, or if the study has no sequence.
  std::string standard_lacks{};
  /// Assumptions of the study, such as "no delay": effects of a real axis that are absent because the
  /// manifest does not name them.
  std::vector<std::string> assumed{};
};

Status status_of(const AcceptedGoal& claim);
/// Status of the whole acceptance: rejected if any claim is rejected, otherwise undecided if any claim is
/// undecided, otherwise accepted.
Status status_of(const Acceptance& acceptance);
/// Exit code of the program for a status: success if accepted, regression if rejected, otherwise
/// inconclusive.
ExitCode exit_code_of(Status status);

/// Judges the measured machines, whose moves are in the logs, by the goals of the study, and compares them
/// with the simulated machines at the design point `point`. If the measured machines are as predicted, the
/// probability that any goal is reported as met less often than predicted is at most 5 %.
/// @param file results file of a study with goals, in one setting (a condition at an age)
/// @param point index of the design point
/// @param logs one log per measured machine
/// @param judged the machines about which the statement is made
///
/// If only these machines are judged, a goal refers to all their moves, or, if it has the key `machines`, to
/// this proportion of the machines. Each machine is then judged by the bounds of its own moves, with the
/// confidence 1 − (1 − γ)/m for m machines.
///
/// A goal that judges only some moves (key `on`) uses the rows of a log whose column `move` has the numbers
/// of these moves. If the study has worlds (draws of what all machines share), the machines differ from the
/// study only if they differ from each world, so the largest p-value decides.
/// @throws Failure: bad_input for a study without machines, for a log without a measure that a goal needs,
/// for a measure in a unit of another dimension than in the study, and for a log that does not number its
/// moves although a goal refers to some moves; bad_data for a log without moves
Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs, Judged judged = Judged::all_machines);

document::AnswerDescription<Acceptance> acceptance_answer();

/// A permutation test of whether the measured machines agree with the simulated ones. If the N measured
/// machines are further draws from the population of the R simulated machines, every choice of N from all N +
/// R machines is equally likely to be the measured one. T is the number of moves that meet the requirement on
/// N randomly chosen machines, each in n of its moves, and k is that number for the measured machines. With B
/// = 9999 random choices
///
///   p₋ = (1 + #{T ≤ k})/(B + 1),  p₊ = (1 + #{T ≥ k})/(B + 1),  p = min(1, 2·min(p₋, p₊)).
///
/// The n moves of a simulated machine are a random choice of its moves. For one machine the test is
/// machine_rank_test(), which needs no random choices if all simulated machines have the same number of
/// moves.
/// @param met [measured machine] number of its first n moves that meet the requirement
/// @param moves n
/// @param simulated machines with n or more moves each
/// @param seed seed of the random choices
Agreement agreement_of(std::span<const std::int64_t> met, std::int64_t moves,
                       std::span<const statistics::MachineMoves> simulated, std::uint64_t seed);

}  // namespace zerocount::acceptance

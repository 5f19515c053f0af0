#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/monitor/move_log.hpp"
#include "analysis/statistics/clusters/machine_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "results/reading/all_trials_file.hpp"

/// Acceptance of built machines: compares their measured moves with the goals and predictions of the study.
namespace zerocount::acceptance {

enum class Status {
  /// Every goal is shown to be met, and none is met less often than predicted.
  accepted,
  rejected,  ///< A goal is shown to be missed, or is met less often than predicted.
  undecided  ///< Neither accepted nor rejected.
};

/// The machines that a goal is judged for.
enum class Judged {
  /// The population from which the measured machines are a sample, as in the goal's claim (goal_verdict.hpp).
  all_machines,
  these_machines  ///< The measured machines alone.
};

/// Test of whether the measured machines agree with the simulated ones.
struct Agreement {
  /// Number of compared moves of each machine: the smallest number that any machine has.
  std::int64_t moves{0};
  std::int64_t met{0};   ///< Number of the measured machines' first `moves` moves that meet the goal.
  double p{1.0};         ///< Two-sided p-value.
  double lowest_p{1.0};  ///< Smallest p-value that is possible with these numbers of machines.
  bool is_lower{false};  ///< True if fewer moves than simulated meet the goal.
  /// Prediction interval (95 %) of the proportion of moves that meet the goal, for as many simulated machines
  /// with as many moves.
  statistics::ConfidenceInterval predicted{0.0, 1.0};
};

/// One goal: what was predicted, and what was measured.
struct Claim {
  study::Goal goal{};
  goal::ClaimVerdict predicted{};  ///< Verdict on the simulated machines.
  /// Verdict on the population from which the measured machines are a sample.
  goal::ClaimVerdict measured{};
  std::int64_t moves{0};  ///< Number of measured moves of all machines that the goal judges.
  std::int64_t met{0};
  /// Proportion of the measured machines' moves that meet the goal, with one-sided bounds, each with the
  /// confidence of the goal.
  goal::BoundedProportion rate{};
  /// Status of the goal for the machines that are judged.
  goal::Status status{goal::Status::undecided};
  /// Significance level at which the measured moves differ from the prediction of this goal: 0.05 divided by
  /// the number of goals (Bonferroni).
  double significance{0.05};
  bool is_below_prediction{false};  ///< True if significantly fewer moves meet the goal than predicted.
  Agreement agreement{};
  /// Number of worlds of the study with which the machines agree. The prediction is that of the world most
  /// like the machines, with the intervals of all worlds. Null if the study has no worlds.
  std::optional<std::int64_t> like_worlds{};
};

/// The moves of one machine, by goal.
struct MeasuredMachine {
  std::string name;
  std::vector<std::int64_t> moves{};  ///< [goal] Number of moves that the goal judges.
  std::vector<std::int64_t> met{};    ///< [goal] Number of these moves that meet the goal.
};

/// A value of ISO 230-2 from encoder counts, for the simulated and the measured machines.
struct StandardValue {
  std::string_view name;    ///< Name, such as "repeatability".
  std::string_view symbol;  ///< Symbol in the standard.
  double median{0.0};       ///< Median of the simulated runs of the test, counts.
  /// Lower end of the range with the central 95 % of the simulated runs, counts.
  double low{0.0};
  double high{0.0};  ///< Upper end of that range, counts.
  /// [run] Value of each measured run of all machines, counts; NaN if it is not defined.
  std::vector<double> measured{};
  std::int64_t within{0};  ///< Number of measured runs between `low` and `high`.
};

struct Acceptance {
  std::string study{};  ///< Name of the results file.
  std::string point{};  ///< Label of the design point.
  std::vector<Claim> claims{};
  std::vector<MeasuredMachine> machines{};
  Judged judged{Judged::all_machines};
  /// Number of machines with which the goals would be decided for all machines. 0: they are decided, or no
  /// number up to 10⁵ suffices.
  std::int64_t needed_machines{0};
  std::int64_t simulated{0};  ///< Number of simulated machines.
  std::int64_t worlds{0};     ///< Number of worlds in the study; 0: none.
  /// Values of ISO 230-2. Empty if the study has no sequence of moves, if a log lacks a column that they
  /// need, or if the logs or the study have no run with these values.
  std::vector<StandardValue> standard_values{};
  /// Column that a log lacks for the values of ISO 230-2: "a.csv has no column final_error". Empty if no
  /// column is lacking, or if the study has no sequence.
  std::string standard_lacks{};
  /// Assumptions of the study, such as "no delay": effects of a real axis that are absent because the
  /// manifest does not name them.
  std::vector<std::string> assumed{};
};

Status status_of(const Claim& claim);
/// Status of all claims together: rejected if any is, otherwise undecided if any is, otherwise accepted.
Status status_of(const Acceptance& acceptance);
/// Exit code of a status: success if accepted, regression if rejected, otherwise inconclusive.
ExitCode exit_code_of(Status status);

/// Judges the logged machines by the goals of the study, and compares them with the study's machines at the
/// point. Machines that are as predicted are found below the prediction of any goal with a probability of at
/// most 5 %.
/// @param file of one setting, with goals
///
/// If only these machines are judged, a goal refers to all their moves, or to `machines` of them. Each
/// machine is then judged by the bounds of its own moves, with the confidence 1 − (1 − γ)/m for m machines.
///
/// A goal `on` some moves is judged by the rows of a log whose column `move` names these moves. With worlds,
/// the machines differ from the study only if they differ from each world, so the largest p-value counts.
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

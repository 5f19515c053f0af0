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

/// Whether measured machines are like simulated ones.
struct Agreement {
  std::int64_t moves{0};  ///< of each machine that are compared: as many as all have
  std::int64_t met{0};    ///< of the measured machines, by their first so many moves
  double p{1.0};          ///< two-sided
  double lowest_p{1.0};   ///< that so many machines could have
  bool is_lower{false};   ///< fewer moves than simulated meet what is asked
  /// 95 % of as many simulated machines meet it in this proportion of as many moves.
  statistics::ConfidenceInterval predicted{0.0, 1.0};
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
  std::string standard_lacks{};  ///< why there are none: "a.csv has no column final_error"; empty: there are
  /// Effects that the study is without, which its manifest does not name.
  std::vector<std::string> assumed{};
};

Status status_of(const Claim& claim);
/// Of all claims: rejected before undecided before accepted.
Status status_of(const Acceptance& acceptance);
/// success for accepted, regression for rejected, inconclusive.
ExitCode exit_code_of(Status status);

/// Judges the machines whose logs these are by the goals of the study, and compares them with its machines at
/// the point, its machines. Machines as predicted are found below the prediction of any goal with a
/// probability of 5 % at most.
/// @param file of one condition, with goals
///
/// For these machines alone, a goal is about the moves of all of them, or about `machines` of them: each is
/// judged by the bounds of its own moves, with the confidence 1 − (1 − γ)/m of m machines.
///
/// A goal `on` some moves is judged by the rows that the column `move` of a log says are of these. Machines
/// that live in one of the worlds of a study differ from it where they differ from each of them: the largest
/// p-value counts.
/// @throws Failure: bad_input for a study without machines, for a log without a measure that a goal asks for,
/// or with it in a unit of another dimension than the study has, and for one that does not number its moves
/// where a goal asks for some; bad_data for a log without moves
Acceptance accept(const reading::AllTrialsFile& file, std::int64_t point,
                  std::span<const monitor::MoveLog> logs, Judged judged = Judged::all_machines);

document::AnswerDescription<Acceptance> acceptance_answer();

/// If N measured machines are further draws from the machines that were simulated, R, any N of all N + R are
/// as likely as any other to be those. With T the moves that meet the requirement, of N random ones of all,
/// each in n of its moves, and k those of the measured machines,
///
///   p₋ = (1 + #{T ≤ k})/(B + 1),  p₊ = (1 + #{T ≥ k})/(B + 1),  p = min(1, 2·min(p₋, p₊)),  B = 9999:
///
/// a permutation test. The n of a simulated machine are a random choice of its moves. For one machine it is
/// machine_rank_test(), which needs no random choices, where all simulated machines have as many moves.
/// @param met [measured machine] in its first n moves @param simulated with n or more moves each
/// @param seed of the random choices
Agreement agreement_of(std::span<const std::int64_t> met, std::int64_t moves,
                       std::span<const statistics::MachineMoves> simulated, std::uint64_t seed);

}  // namespace zerocount::acceptance

#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/move_behaviour.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

/// Stages of a tuning: what is tuned, the search for the best values, the behaviour of the best values, and
/// their proof. Each stage is a function of the results of the earlier stages.
namespace zerocount::tuning {

/// A part of the tuning's answer that is missing because the effort was not enough.
struct LeftOut {
  std::string part;
  /// Name of the extra (optional part of the answer) to which the part belongs; empty: no extra.
  std::string_view extra{};

  bool operator==(const LeftOut&) const = default;
};

/// Runs `work`, which spends the effort. Returns true if it ended; false if the effort was not enough, or if
/// a stop was requested.
bool ended(const trials::Effort& effort, const std::function<void()>& work);

/// The search space of a tuning: the study with its free parameters, the budget and the effort.
struct Space {
  const study::Study& study;  ///< Study that is tuned, on whose machines values are simulated.
  TuneBudget budget{};
  trials::Effort effort{};  ///< Effort (trials and time) of all stages of the tuning together.
  /// Simulation speed with which a budget of time is planned, trials/s; infinity without a limit of time.
  double speed{std::numeric_limits<double>::infinity()};
  /// Simulation speed from which durations are estimated, trials/s; 0 if it was not measured.
  double measured_speed{0.0};

  const std::vector<study::FreeParameter>& free() const { return study.tuning->free; }
  bool has_budget() const { return budget.trials || budget.seconds; }
};

/// Checks that a study can be tuned.
/// @throws Failure (bad_input) if the manifest does not say what to tune, or the study has several design
/// points
void require_tunable(const study::Study& study);

/// Makes the space of a tuning. Its speed is measured if the budget has a time and no speed is known.
/// @param known_speed speed measured by an earlier run, trials/s; nothing: none
/// @throws trial::Interrupted if a stop is requested or the time is over
Space space_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
               const std::optional<double>& known_speed);

/// Result of the search stage of a tuning.
struct Searched {
  /// Result of search(). Its numbers of points and trials include the searches for other controls.
  SearchResult result{};
  /// Frontier between success and speed (frontier_of()), the fastest point first.
  std::vector<TriedPoint> frontier{};
  std::int64_t examined{0};  ///< Number of sets of values whose stability margins were examined.
  Landscape landscape{};
};

/// Searches for the best values of the free parameters. Sets the speeds of the space to the speed that the
/// search had.
/// @param tell called after each generation
/// @throws trial::Interrupted if a stop is requested
Searched search_values(Space& space, StudySearch& search, const SearchPlan& plan,
                       const std::function<void(const SearchProgress&)>& tell);

/// Explanation for a search in which no values keep the margins.
struct Unfound {
  /// Examined set of values closest to the wanted stability margins; nothing if none was allowed.
  std::optional<NearestPoint> nearest{};
  std::string refusal{};  ///< Why no examined set of values was allowed; empty if some was.
};
/// Explains a search in which no values keep the margins: finds the closest ones, or why none was allowed.
Unfound nearest_to_margins(const StudySearch& search);

/// Stability margins of a set of values, and the behaviour of the moves, on machines of the search.
struct Examined {
  Values values;
  std::optional<SmallestMargins> margins{};
  /// LoopExaminer::lowest_mode(), the lowest frequency of a load mode that leaves all loops stable, Hz;
  /// nothing: not known.
  std::optional<double> lowest_mode{};
  bool slides{false};  ///< Whether the margins include the loops of sliding machines.
  /// Behaviour of the moves of some machines, such as their overshoot.
  std::vector<summary::MoveBehaviour> moves{};
};

/// Computes the stability margins and the lowest load mode for examined.values, and stores them in
/// `examined`.
/// @param slides whether the machines slide with these values
/// @throws trial::Interrupted if `stop` is requested
void examine_margins(const StudySearch& search, bool slides, const std::stop_token& stop, Examined& examined);

/// Behaviour of the moves of the first `count` machines, each with one trial in each setting. The torque
/// at rest is measured from the dwell within `verdict.rest_band` on. If the study does not measure it, the
/// band is the largest band or tolerance of the goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<summary::MoveBehaviour> simulated_behaviour(const study::Study& study,
                                                        const trials::Replicates& machines,
                                                        std::int64_t count, const trials::Effort& effort);

/// Results of the tuned study on machines that the search did not use (proof that the values meet the goals).
struct Proof {
  study::Study study;
  /// Verdict that `judge` gives on the results file. The confidence of its bounds allows for all attempts.
  goal::Verdict verdict;
  /// Study size that would decide an undecided verdict; nothing otherwise.
  std::optional<goal::Needs> needs{};
  /// Number of attempts to prove values (with other candidates or more machines), including this one.
  int attempts{1};
  /// Claims (goals in settings) with confidence bounds that allow for all attempts.
  std::vector<summary::CellOfPoint> claims{};
  /// RateEstimate::criterion, the quantity that the tuning minimises; infinity for "never".
  double criterion{0.0};
  /// Value that the criterion's measure does not exceed in the proportion of moves that the goal asks for
  /// (study::Goal::moves), for the worst goal in its worst setting.
  double late_limit{0.0};
  std::optional<WorstMachine> worst{};
  /// Reasons from theory why a goal is not met; empty if there are none.
  std::vector<std::string> obstacles{};
  std::vector<summary::MoveBehaviour> moves{};
  /// ProvenFinalist::keeps_margins: whether the values keep the wanted stability margins.
  bool keeps_margins{true};
  /// ProvenFinalist::all_tried: whether every finalist that may meet the goals was run.
  bool all_tried{true};

  /// Whether the values cannot be the answer, because they miss a goal or violate a stability margin.
  bool fails() const { return !keeps_margins || verdict.status == goal::Status::missed; }
};

/// Evaluates a finished proof, the simulation of the tuned study on fresh machines.
/// @param study study with one design point
/// @param machines machines of the study
/// @param results results of these machines
/// @param file results file with their trials
Proof proof_of(study::Study study, const trials::Replicates& machines, std::span<const MachineResult> results,
               const reading::AllTrialsFile& file);

/// Results file that a proof writes, and the number of threads that run it.
struct ProofPlace {
  std::filesystem::path output;
  int threads{0};
};

/// The last attempt of prove_values() to prove a finalist of the search.
struct Proven {
  std::size_t finalist{0};  ///< Index in SearchResult::finalists of the finalist that was run.
  bool slid{false};         ///< Whether machines slid with these values in the search or in the proof.
  Proof proof;
};

/// Proves on fresh machines that finalists of a search meet the goals (prove()).
/// @returns the last attempt; nothing if the time ended before the first attempt
/// @throws Failure (interrupted) if a stop was requested
std::optional<Proven> prove_values(const Space& space, StudySearch& search, const SearchResult& found,
                                   const ProofPlace& place, status::StatusLine& line);

/// Status of a tuning from its proof and its search. A failed proof is "undecided" by default. It is "missed"
/// if the rates gave the search a direction (Landscape::leads), the search came no closer at its end, and all
/// finalists that may meet the goal were tried. It is also "missed" if theory excludes the goal for all
/// gains.
goal::Status status_of(const Proof& proof, const Searched& searched);

/// Sentences for the values at an end of their range, such as "controller.ki = 5000 is at the lower end of
/// its range".
std::vector<std::string> edges_of(const std::vector<study::FreeParameter>& free, const Values& values);

}  // namespace zerocount::tuning

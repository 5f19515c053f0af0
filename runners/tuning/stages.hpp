#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/summary/cells_of_point.hpp"
#include "analysis/summary/move_behaviour.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/search/proof_runner.hpp"
#include "runners/tuning/tune_plan.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

/// Stages of a tuning: the space, the search in it, the behaviour of the best values, and their proof. Each
/// stage is a function of the results of the earlier stages.
namespace zerocount::tuning {

/// A part of the answer that is missing because the effort was not enough.
struct LeftOut {
  std::string part;
  std::string_view extra{};  ///< Name of the extra to which the part belongs; empty: no extra.

  bool operator==(const LeftOut&) const = default;
};

/// Runs `work`. Returns whether it ended within the effort and without an interruption.
bool ended(const trials::Effort& effort, const std::function<void()>& work);

/// The tuned study, with the budget and the effort of its tuning.
struct Space {
  const study::Study& study;  ///< Study whose machines are simulated.
  TuneBudget budget{};
  trials::Effort effort{};  ///< Effort of all stages together.
  /// Speed for planning a budget of time, trials/s; infinity without a limit of time.
  double speed{std::numeric_limits<double>::infinity()};
  double measured_speed{0.0};  ///< Speed for estimating times, trials/s; 0 if it was not measured.

  const std::vector<study::FreeParameter>& free() const { return study.tuning->free; }
  bool has_budget() const { return budget.trials || budget.seconds; }
};

/// Checks that a study can be tuned.
/// @throws Failure (bad_input) if the manifest does not say what to tune, or the study has several design
/// points
void require_tunable(const study::Study& study);

/// Space of a tuning. Its speed is measured if the budget has a time and no speed is known.
/// @param known_speed speed measured by an earlier run, trials/s
/// @throws trial::Interrupted
Space space_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
               const std::optional<double>& known_speed);

/// Result of a search.
struct Searched {
  SearchResult result{};               ///< Its points and trials include the searches for other controls.
  std::vector<TriedPoint> frontier{};  ///< Frontier between success and speed (frontier_of()).
  std::int64_t examined{0};            ///< Number of points whose margins were examined.
  Landscape landscape{};
};

/// Searches for the best values. Sets the speed of the space to the measured one.
/// @param tell called after each generation
/// @throws trial::Interrupted
Searched search_values(Space& space, StudySearch& search, const SearchPlan& plan,
                       const std::function<void(const SearchProgress&)>& tell);

/// Explanation for a search that found no values.
struct Unfound {
  std::optional<NearestPoint> nearest{};  ///< Examined point closest to the wanted margins.
  std::string refusal{};                  ///< Why no point at all was allowed; empty if some point was.
};
/// Explains a search that found no values.
Unfound nearest_to_margins(const StudySearch& search);

/// Margins and moves of values, on machines of the search.
struct Examined {
  Values values;
  std::optional<SmallestMargins> margins{};
  std::optional<double> lowest_mode{};          ///< LoopExaminer::lowest_mode(), Hz.
  bool slides{false};                           ///< Whether the margins include loops of sliding machines.
  std::vector<summary::MoveBehaviour> moves{};  ///< Behaviour of the moves of some machines.
};

/// Sets the margins and the lowest mode of `examined`.
/// @param slides whether the machines slide with these values
/// @throws trial::Interrupted
void examine_margins(const StudySearch& search, bool slides, const std::stop_token& stop, Examined& examined);

/// Behaviour of the moves of the first `count` machines, each with one trial in each setting. The torque
/// at rest is measured from the dwell within `verdict.rest_band` on. If the study does not measure it, the
/// band is the largest band or tolerance of the goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<summary::MoveBehaviour> simulated_behaviour(const study::Study& study,
                                                        const trials::Replicates& machines,
                                                        std::int64_t count, const trials::Effort& effort);

/// Results of the tuned study on machines that the search did not use.
struct Proof {
  study::Study study;
  goal::Verdict verdict;  ///< Verdict of `judge` on the results file; its confidence allows for all attempts.
  std::optional<goal::Needs> needs{};  ///< Study size that would decide an undecided verdict.
  /// Number of attempts (candidates or sizes), including this one.
  int attempts{1};
  std::vector<summary::CellOfPoint> claims{};  ///< Claims with bounds that allow for all attempts.
  double criterion{0.0};                       ///< Estimate::criterion; infinity for "never".
  /// Quantile of the criterion's values of the worst goal in its worst setting, at the probability
  /// study::Goal::moves.
  double late_limit{0.0};
  std::optional<WorstMachine> worst{};
  std::vector<std::string> obstacles{};  ///< Reasons from theory why a goal is not met.
  std::vector<summary::MoveBehaviour> moves{};
  bool keeps_margins{true};  ///< ProvenFinalist::keeps_margins
  bool all_tried{true};      ///< ProvenFinalist::all_tried

  /// Whether the values are not an answer, because they miss a goal or violate a margin.
  bool fails() const { return !keeps_margins || verdict.status == goal::Status::missed; }
};

/// Evaluates a finished proof.
/// @param study study with one design point
/// @param machines machines of the study
/// @param results results of these machines
/// @param file results file with their trials
Proof proof_of(study::Study study, const trials::Replicates& machines, std::span<const MachineResult> results,
               const reading::AllTrialsFile& file);

/// Results file of a proof, and the number of threads that make it.
struct ProofPlace {
  std::filesystem::path output;
  int threads{0};
};

/// The proof that prove_values() ended with.
struct Proven {
  std::size_t finalist{0};  ///< Index in SearchResult::finalists.
  bool slid{false};         ///< Whether machines slid in the search or in the proof.
  Proof proof;
};

/// Proves the finalists of a search (prove()).
/// @returns the last attempt; nothing if the time ended before the first attempt
/// @throws Failure (interrupted)
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

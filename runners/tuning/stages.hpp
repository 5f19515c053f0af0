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

/// The stages of a tuning, each a function of what the earlier ones found: the space, the search in it, what
/// its best values do, and their proof.
namespace zerocount::tuning {

/// A part of the answer for which the effort was not enough.
struct LeftOut {
  std::string part;
  std::string_view extra{};  ///< to which it belongs; empty: to none

  bool operator==(const LeftOut&) const = default;
};

/// Whether the work ended within the effort, and without an interruption.
bool ended(const trials::Effort& effort, const std::function<void()>& work);

/// What is tuned, and what it may take.
struct Space {
  const study::Study& study;  ///< whose machines are simulated
  TuneBudget budget{};
  trials::Effort effort{};  ///< of all stages
  /// By which a budget is planned, trials/s; infinite without a limit of time.
  double speed{std::numeric_limits<double>::infinity()};
  double measured_speed{0.0};  ///< by which times are estimated, trials/s; 0 where nothing was measured

  const std::vector<study::FreeParameter>& free() const { return study.tuning->free; }
  bool has_budget() const { return budget.trials || budget.seconds; }
};

/// @throws Failure (bad_input) if the study does not say what to tune, or has several points
void require_tunable(const study::Study& study);

/// @param known_speed of an earlier run; else it is measured, if a time is to be planned
/// @throws trial::Interrupted
Space space_of(const study::Study& study, const TuneBudget& budget, const trials::Effort& effort,
               const std::optional<double>& known_speed);

/// What a search found.
struct Searched {
  SearchResult result{};               ///< its points and trials with those for other controls
  std::vector<TriedPoint> frontier{};  ///< between success and speed
  std::int64_t examined{0};            ///< points whose margins were examined
  Landscape landscape{};
};

/// Searches, and measures the speed of the space by it.
/// @param tell called after each generation @throws trial::Interrupted
Searched search_values(Space& space, StudySearch& search, const SearchPlan& plan,
                       const std::function<void(const SearchProgress&)>& tell);

/// Why a search found no values.
struct Unfound {
  std::optional<NearestPoint> nearest{};
  std::string refusal{};  ///< why no point at all was allowed; empty if any was
};
Unfound nearest_to_margins(const StudySearch& search);

/// What values do, on machines of the search.
struct Examined {
  Values values;
  std::optional<SmallestMargins> margins{};
  std::optional<double> lowest_mode{};          ///< of a load, that the loops bear (LoopExaminer), Hz
  bool slides{false};                           ///< whether the machines of the margins slide
  std::vector<summary::MoveBehaviour> moves{};  ///< of some machines
};

/// Sets the margins. @param slides whether the machines of the values slide @throws trial::Interrupted
void examine_margins(const StudySearch& search, bool slides, const std::stop_token& stop, Examined& examined);

/// How the moves of the first `count` units are made, each with one trial under each condition. The torque at
/// rest is measured from the dwell within `verdict.rest_band` on; where the study does not measure it, within
/// the largest band or tolerance of its goals.
/// @throws trial::Interrupted, trials::Spent
std::vector<summary::MoveBehaviour> simulated_behaviour(const study::Study& study,
                                                        const trials::Replicates& units, std::int64_t count,
                                                        const trials::Effort& effort);

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;  ///< as `judge` gives it on the results file; its confidence allows for all attempts
  std::optional<goal::Needs> needs{};          ///< that would decide an undecided one
  int attempts{1};                             ///< candidates or sizes that were proven, this one included
  std::vector<summary::CellOfPoint> claims{};  ///< with bounds that allow for all attempts
  double criterion{0.0};                       ///< infinite for never
  /// Quantile study::Goal::moves of the criterion's values of the worst goal, under its worst condition.
  double late_limit{0.0};
  std::optional<WorstMachine> worst{};
  std::vector<std::string> obstacles{};  ///< what keeps the axis from a goal that is not met, in theory
  std::vector<summary::MoveBehaviour> moves{};
  bool keeps_margins{true};  ///< ProvenFinalist::keeps_margins
  bool all_tried{true};      ///< ProvenFinalist::all_tried

  /// Whether the values are no answer: they miss a goal or do not keep a margin.
  bool fails() const { return !keeps_margins || verdict.status == goal::Status::missed; }
};

/// @param study of one point, and its units @param file of its trials @param results of these
Proof proof_of(study::Study study, const trials::Replicates& units, std::span<const UnitResult> results,
               const reading::AllTrialsFile& file);

/// Where a proof is written.
struct ProofPlace {
  std::filesystem::path output;
  int threads{0};
};

struct Proven {
  std::size_t finalist{0};
  bool slid{false};  ///< whether machines slid in the search, or in the proof
  Proof proof;
};

/// Proves the best finalist that can be proven (prove()). @returns nothing if the time ended before the first
/// attempt
/// @throws Failure (interrupted)
std::optional<Proven> prove_values(const Space& space, StudySearch& search, const SearchResult& found,
                                   const ProofPlace& place, status::StatusLine& line);

/// What the proof and its search say together: a goal that the proof misses is undecided unless the search
/// followed rates that rise, came no nearer at the end, and all that may meet the goal was tried; or theory
/// excludes it for all gains.
goal::Status status_of(const Proof& proof, const Searched& searched);

/// "controller.ki = 5000 is at the lower end of its range".
std::vector<std::string> edges_of(const std::vector<study::FreeParameter>& free, const Values& values);

}  // namespace zerocount::tuning

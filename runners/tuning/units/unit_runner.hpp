#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/variant.hpp"
#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/units/finer_units.hpp"

/// Tuning of a study: the search on machines of its own, the proof on others, and what the answer rests on.
namespace zerocount::tuning {

/// The paths of free parameters.
std::vector<std::string> names_of(std::span<const study::FreeParameter> free);

/// The study with these values; nothing where such values together are not allowed.
std::optional<study::Study> at_values(const study::Study& study, std::span<const study::FreeParameter> free,
                                      const Values& values);

/// "controller.ki=5000", in digits that read back to the same value.
std::vector<std::string> overrides_of(std::span<const study::FreeParameter> free, const Values& values);

/// The quantity that tuning minimises, of the moves of one goal.
struct Criterion {
  const layout::Measure* measure{nullptr};
  double quantile{0.95};
  /// The time that the goal allows a move: settling times of several goals are compared as parts of it.
  std::optional<study::TimeLimit> scale{};
};

/// [goal]; one of success without a goal. The criterion of a candidate is the largest of all goals and
/// conditions.
/// @throws Failure (bad_input) if Tuning::minimise names no quantile of a measure
std::vector<Criterion> criteria_of(const study::Study& study);
/// Its name: "band_settling_time.p95", "tolerance_settling_time.p95" where all goals have tolerances, of
/// goals of both kinds "goal_settling_time.p95".
std::string criterion_name(const study::Study& study);
/// Whether it is of the settling times within the bands or tolerances of the goals.
bool is_of_settling(const study::Study& study);
/// Whether the criterion is a settling time as a proportion of what its goal allows.
bool is_proportion_of_allowed(const study::Study& study);

/// The goals of the study under each of its conditions.
Aim aim_of(const study::Study& study);
/// The goal of a claim, and its condition: Aim::claims is goal by goal.
struct ClaimPlace {
  std::size_t goal{0};
  std::size_t condition{0};
};
ClaimPlace place_of_claim(const study::Study& study, std::size_t claim);
std::size_t claim_at(const study::Study& study, const ClaimPlace& place);
/// " 'small' under condition loaded", as far as the study has several goals, and conditions.
std::string claim_text(const study::Study& study, const ClaimPlace& place);
/// Whether there is more than one goal, or any condition.
bool has_named_claims(const study::Study& study);
/// How data name a claim.
struct ClaimNames {
  std::optional<std::string>
      goal{};  ///< nothing of a study that has no other claim, or of a goal without a name
  std::optional<std::string> condition{};  ///< nothing without conditions
};
ClaimNames names_of(const study::Study& study, const ClaimPlace& place);

/// Changes the parameters of a trial after they are drawn.
using Change = std::function<void(trial::TrialParameters&)>;

/// Units [from, to) of a study.
struct UnitsToRun {
  const study::Study* study{nullptr};
  std::int64_t from{0};
  std::int64_t to{0};
  std::vector<UnitResult>* results{nullptr};  ///< get one entry a unit, [claim of aim_of()]
  const Change* change{nullptr};              ///< null: none
  FinerUnits finer{};                         ///< Units of its trials.
};

/// What trials show that all are of one unit, under the first condition.
UnitResult result_of(const study::Study& study, std::span<const trial::TrialOutcome> outcomes);

/// Runs the trials of all entries on all cores. The results do not depend on the number of cores.
/// @param units of each of the studies
/// @throws trial::Interrupted, trials::Spent
void run_units(std::span<const UnitsToRun> entries, const trials::Replicates& units,
               const trials::Effort& effort);

/// The results of the first `count` units of a study.
/// @param change null: none
/// @throws trial::Interrupted, trials::Spent
std::vector<UnitResult> results_of(const study::Study& study, const trials::Replicates& units,
                                   std::int64_t count, const Change* change, const trials::Effort& effort);

/// The results of all units of a study of one point, from its results file.
std::vector<UnitResult> results_in(const reading::AllTrialsFile& file, const study::Study& study,
                                   const trials::Replicates& units);

}  // namespace zerocount::tuning

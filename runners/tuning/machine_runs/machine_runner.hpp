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
#include "runners/tuning/machine_runs/finer_units.hpp"
#include "runners/tuning/race/candidate.hpp"

/// Simulates the machines of a tuned study, and counts how many moves meet its goals.
namespace zerocount::tuning {

/// Names (dotted paths) of the free parameters, such as "controller.ki".
std::vector<std::string> names_of(std::span<const study::FreeParameter> free);

/// Copy of the study in which the free parameters have these values; nothing if the values are not allowed
/// together.
std::optional<study::Study> at_values(const study::Study& study, std::span<const study::FreeParameter> free,
                                      const Values& values);

/// Overrides such as "controller.ki=5000" that give the free parameters these values, with enough digits to
/// read back the same values.
std::vector<std::string> overrides_of(std::span<const study::FreeParameter> free, const Values& values);

/// Quantity that tuning minimises: a quantile of a measure over the moves of one goal.
struct Criterion {
  const layout::Measure* measure{nullptr};
  double quantile{0.95};
  /// Time that the goal allows for a move. If set, settling times are divided by it, so that several goals
  /// can be compared.
  std::optional<study::TimeLimit> scale{};
};

/// [goal] Criterion of each goal; a single one if the study has no goal. The criterion of a candidate is the
/// largest over all goals and settings.
/// @throws Failure (bad_input) if Tuning::minimise names no quantile of a measure
std::vector<Criterion> criteria_of(const study::Study& study);
/// Name of the criterion: "band_settling_time.p95" if all goals have bands, "tolerance_settling_time.p95" if
/// all have tolerances, "goal_settling_time.p95" if there are goals of both kinds; otherwise
/// Tuning::minimise.
std::string criterion_name(const study::Study& study);
/// Whether the quantity that the tuning minimises is a settling time within the bands or tolerances of the
/// goals.
bool is_of_settling(const study::Study& study);
/// Whether the quantity that the tuning minimises is a settling time divided by the time that its goal
/// allows.
bool is_proportion_of_allowed(const study::Study& study);

/// The aim of a tuning: the claims that all goals of the study hold in each of its settings (conditions at
/// ages), and the quantile to minimise.
Aim aim_of(const study::Study& study);
/// Goal and setting (condition at an age) of a claim, as indices. Aim::claims is ordered goal by goal.
struct ClaimPlace {
  std::size_t goal{0};
  std::size_t setting{0};
};
ClaimPlace place_of_claim(const study::Study& study, std::size_t claim);
std::size_t claim_at(const study::Study& study, const ClaimPlace& place);
/// Text such as " 'small' under condition loaded" for a claim. It names the goal only if there are several,
/// and the setting (condition at an age) only if there are any.
std::string claim_text(const study::Study& study, const ClaimPlace& place);
/// Whether claims need names in texts: the study has more than one goal, or any setting (condition at an
/// age).
bool has_named_claims(const study::Study& study);
/// Names by which the answer's data identify a claim (a goal in a setting).
struct ClaimNames {
  /// Name of the claim's goal; nothing if the study has no other claim or the goal has no name.
  std::optional<std::string> goal{};
  /// Name of the claim's setting (condition at an age); nothing without settings.
  std::optional<std::string> setting{};
};
ClaimNames names_of(const study::Study& study, const ClaimPlace& place);

/// Function that changes the parameters of a trial after they are drawn, for example to switch off an effect.
using Change = std::function<void(trial::TrialParameters&)>;

/// One entry of the list of runs: the machines [from, to) of a study that are to be simulated.
struct MachinesToRun {
  const study::Study* study{nullptr};
  std::int64_t from{0};
  std::int64_t to{0};
  /// [machine] Receives the results, with one claim for each of aim_of().
  std::vector<MachineResult>* results{nullptr};
  const Change* change{nullptr};  ///< Changes the parameters of each drawn trial; null: no change.
  /// Units in which the changed trials count and sample, if they differ from the study's.
  FinerUnits finer{};
};

/// Counts the outcomes of trials that all belong to one machine, in the first setting (condition at an age).
MachineResult result_of(const study::Study& study, std::span<const trial::TrialOutcome> outcomes);

/// Simulates the machines of all entries on all cores. The results do not depend on the number of cores.
/// @param machines machines of each study, with their trials
/// @throws trial::Interrupted if a stop is requested or the time is over
/// @throws trials::Spent if the trials of `effort` are not enough
void run_machines(std::span<const MachinesToRun> entries, const trials::Replicates& machines,
                  const trials::Effort& effort);

/// Simulates the first `count` machines of a study. Returns their results.
/// @param change changes the parameters of each drawn trial; null: no change
/// @throws trial::Interrupted if a stop is requested or the time is over
/// @throws trials::Spent if the trials of `effort` are not enough
std::vector<MachineResult> results_of(const study::Study& study, const trials::Replicates& machines,
                                      std::int64_t count, const Change* change, const trials::Effort& effort);

/// [machine] Results of all machines of a study with one design point, read from its results file.
std::vector<MachineResult> results_in(const reading::AllTrialsFile& file, const study::Study& study,
                                      const trials::Replicates& machines);

}  // namespace zerocount::tuning

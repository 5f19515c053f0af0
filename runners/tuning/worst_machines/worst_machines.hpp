#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// A machine as a point of the box, given by a quantile for each of its random inputs.
struct BoxPoint {
  /// Index of the machine of the study whose profiles (parameters that vary along the axis) it has; 0 without
  /// machines.
  std::int64_t machine{0};
  /// [machine input] Probability (0 to 1) of the input's value in its distribution.
  std::vector<double> quantiles;
  /// [stage of a race] Result of the trials up to this stage, all goals together.
  std::vector<ClaimResult> results{};
};

/// Regions in which the worst machine is sought. `box`: each input of the machine is within the central 99.9
/// % of its distribution. `likely`: machines of the box whose normal scores z satisfy Σ z² ≤ the 99.9 %
/// quantile of χ²; correlations are ignored.
enum class MachineRegion { box, likely };

/// Converts a place in one dimension of the box, 0 (lower end) to 1 (upper end), to the probability of the
/// input's value in its distribution. The box holds the central 99.9 % of each input.
double quantile_at(double place);
/// Converts the probability of an input's value in its distribution to the place 0 to 1 in the box, the
/// inverse of quantile_at(); 0 or 1 outside the box.
double place_at(double quantile);

/// Box of machines at a design point of a study: machines whose inputs are each within the central 99.9 % of
/// their distribution.
class MachineBox {
 public:
  /// @param study study in one setting (condition at an age)
  /// @param point index of the design point
  /// @throws Failure (bad_input) if the study draws nothing that differs between machines
  MachineBox(study::Study study, std::int64_t point);

  const study::Study& study() const { return given_; }
  std::int64_t point() const { return point_; }
  const std::vector<study::MachineInput>& inputs() const { return inputs_; }

  /// Parameters of the design point that are profiles (they vary along the axis): index of the value, and its
  /// description.
  const std::vector<std::pair<std::size_t, const study::Value*>>& profiles() const { return profiles_; }
  bool has_profile_per_machine() const { return has_profile_per_machine_; }

  /// Box point of a machine of the study. If the study has no machines: of the machine that runs the trial
  /// with this number.
  BoxPoint machine_of(std::int64_t machine) const;
  /// Moves a point into the region and to values that a machine can have, by steps towards the median of each
  /// input. Each quantile is first clamped to the box.
  BoxPoint inside(BoxPoint point, MachineRegion region) const;
  /// Whether the machine is in MachineRegion::likely, so that it is not an improbable combination of inputs.
  bool is_likely(const BoxPoint& point) const;
  /// Parameters of a trial of the machine, drawn with the random numbers of trial `number`.
  trial::TrialParameters trial_of(const BoxPoint& point, std::int64_t number) const;

 private:
  /// Whether the input is a row of a table of joint samples, which sets several parameters at once.
  bool is_row(std::size_t input) const { return inputs_[input].slots.size() > 1; }
  double excess_of(const BoxPoint& point, MachineRegion region) const;
  void approach_median(BoxPoint& point, double divisor) const;
  study::GivenDraws draws_of(const BoxPoint& point, std::int64_t number) const;

  study::Study given_;
  std::int64_t point_;
  std::vector<study::MachineInput> inputs_;
  study::Study searched_;  ///< The study, changed so that any number of trials can be drawn independently.
  std::vector<std::pair<std::size_t, const study::Value*>> profiles_;
  bool has_profile_per_machine_{false};
};

/// Settings for the manifest that describes one machine.
struct MachineManifest {
  std::string condition{};  ///< Name of the condition under which the machine runs; empty: there is none.
  /// Folder to which paths in the study's manifest are relative; nothing: the manifest is not a file.
  std::optional<std::filesystem::path> folder{};
  std::int64_t trials{0};  ///< Number of trials that the manifest asks for with the described machine.
};

/// Number of machines in the manifest that describes a machine. It is more than one only if each machine has
/// a profile of its own (a parameter that varies along the axis). The described machine is the last one, and
/// its trials are every machines_of_manifest()-th trial.
std::int64_t machines_of_manifest(const MachineBox& box, const BoxPoint& point);

/// Text of a manifest that describes one machine. Values, as they act at the machine's age, replace their
/// distributions. All else is as in the study.
/// @param values values of the machine's inputs, by their names
/// @throws Failure (bad_input) if a value with aging is drawn anew for each friction contact, or once for all
/// machines
std::string manifest_of(const MachineBox& box, const BoxPoint& point,
                        const std::vector<std::pair<std::string, double>>& values,
                        const MachineManifest& manifest);

/// Values by the dotted paths of their parameters.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// The worst machine among those of a study, by its trials in the study.
struct WorstMachine {
  /// Index of the machine in the study, or number of its trial if no trials share a machine.
  std::int64_t machine{0};
  std::int64_t trial{0};  ///< Number of the machine's worst trial in `claim`.
  double met{0.0};        ///< Proportion of the machine's moves that meet the goal of `claim`.
  NamedValues inputs;     ///< Names and values of the random inputs of the machine.
  /// Goal and setting (condition at an age) that the machine meets in the smallest proportion of moves.
  ClaimPlace claim{};
  ClaimNames names{};  ///< Names of the goal and the setting (condition at an age) of `claim`.
};

/// Finds the machine of a study with the smallest proportion of moves that meet a goal in a setting
/// (condition at an age). Ties go to the machine with the largest criterion.
/// @param point index of the design point
/// @param results results of all machines of the study
WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const MachineResult> results);

/// A machine in a setting (condition at an age), judged by fresh trials.
///
/// The machine has a manifest in which values replace the distributions, so that nothing drawn differs
/// between machines, and the overrides of the setting are written into the sections. The machine is judged by
/// the trials of this manifest. Neither the study nor a search has used these trials.
struct JudgedMachine {
  std::int64_t setting{0};
  /// Name of the setting (condition at an age); nothing without settings.
  std::optional<std::string> setting_name{};
  /// Index of the machine of the study whose profiles (parameters that vary along the axis) it has; 0 without
  /// machines.
  std::int64_t machine{0};
  std::int64_t trial{0};  ///< Number of the machine's worst trial in the manifest.
  std::int64_t moves{0};  ///< Number of simulated moves by which the machine is judged.
  double met{0.0};        ///< Proportion, 0 to 1, of these moves that meet all goals that judge them.
  /// Name of the goal that is met least often; nothing if there is only one goal.
  std::optional<std::string> goal{};
  NamedValues inputs;  ///< Names and values of the random inputs of the machine.
  /// [machine input] Probability (0 to 1) of the input's value in its distribution (study::machine_inputs).
  std::vector<double> quantiles;
  /// Text of the manifest that describes the machine; empty if none can describe it.
  std::string manifest;
  std::string no_manifest;  ///< Why no manifest can describe the machine; empty if one can.
  /// Whether the machine equals the one listed before it in the answer: WorstMachines::in_box equals `again`,
  /// or WorstMachines::likely equals `in_box`.
  bool is_previous{false};
};

/// Values of the machine inputs of a design point at the lower ends, the medians and the upper ends of the
/// box.
struct BoxEdges {
  NamedValues low, median, high;
};

/// Values of the machine inputs at these quantiles.
/// @param study study in one setting (condition at an age)
/// @param point index of the design point
/// @param quantiles [machine input] probability (0 to 1) in the input's distribution (study::machine_inputs)
NamedValues values_at(const study::Study& study, std::int64_t point, std::span<const double> quantiles);

/// The worst machines of a design point, among those of the study and among those that its distributions
/// allow.
struct WorstMachines {
  WorstMachine of_study;  ///< Worst machine of the study, judged by its trials in the study.
  JudgedMachine again;    ///< The machine of_study, judged by fresh trials like in_box and likely.
  /// Worst machine of the study and of MachineRegion::box, whose inputs are each within their central 99.9 %.
  /// Corners of the box may be machines that nobody builds.
  JudgedMachine in_box;
  /// Worst machine of MachineRegion::likely, which leaves out improbable combinations of inputs.
  JudgedMachine likely;
  /// Whether each machine has profiles of its own (parameters that vary along the axis).
  bool with_profiles{false};
  BoxEdges edges{};  ///< Values of the machine inputs at the edges of the box, in the setting of in_box.
};

/// Finds the machines with the smallest proportion of moves that meet the goals. Ties go to the machine whose
/// moves have the larger score (measures::MoveScore::event, which `rare` uses too). The search in the box
/// starts from the worst machines of the study, the corners, and points that fill the box. With settings,
/// the search is made in each setting, and the answer is the worst of all.
///
///     race of some machines, on the same random numbers: 4 trials each; the worst quarter goes on to 16
///       trials, the worst quarter of these to 64 trials; the 8 worst are kept
///     population = race of the first machines
///     8 times: population = race of the population and of 32 children, each near a machine of the
///       population; a child goes on only while it is worse than some machine of the population on the
///       same trials
///     likely machines: sought only if a machine of the box misses a move
///     the worst machine is judged by 256 trials of its own
///
/// @param folder folder to which paths in the study's manifest are relative; nothing if the manifest is not a
/// file
/// @throws trial::Interrupted, trials::Spent; Failure (bad_input) if the study draws nothing that differs
/// between machines
WorstMachines worst_machines(const study::Study& study, const trials::Replicates& machines,
                             const std::optional<std::filesystem::path>& folder,
                             const trials::Effort& effort);

/// Approximate number of trials that worst_machines() simulates.
std::int64_t trials_of_worst_machines(const study::Study& study, const trials::Replicates& machines);

/// Why no manifest can describe a single machine of the design point at its age; empty if one can. The reason
/// is a value with `aging` that is drawn per friction contact or per study.
std::string refusal_of_manifests(const study::Study& study, std::int64_t point);

}  // namespace zerocount::tuning

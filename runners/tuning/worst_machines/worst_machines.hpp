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
#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// A machine: a machine, and [machine input] the quantile that it has.
struct BoxPoint {
  std::int64_t machine{0};
  std::vector<double> quantiles;
  std::vector<ClaimResult> results{};  ///< [stage of a race] of its first trials, all goals together
};

/// The machines among which the worst is sought. likely: those of the box with Σ z² ≤ the 99.9 % quantile of
/// χ², of the normal scores z of their inputs, without correlations.
enum class MachineRegion { box, likely };

/// The quantile of an input at a place 0 to 1 of the box, which holds the central 99.9 % of each input.
double quantile_at(double place);
/// Its inverse; 0 or 1 for a quantile outside the box.
double place_at(double quantile);

/// The machines of a point of a study: those within the central 99.9 % of each input.
class MachineBox {
 public:
  /// @param study under one condition
  /// @throws Failure (bad_input) if it draws nothing that differs between machines
  MachineBox(study::Study study, std::int64_t point);

  const study::Study& study() const { return given_; }
  std::int64_t point() const { return point_; }
  const std::vector<study::MachineInput>& inputs() const { return inputs_; }

  /// The values of the point that are profiles, by their slots.
  const std::vector<std::pair<std::size_t, const study::Value*>>& profiles() const { return profiles_; }
  bool has_profile_per_machine() const { return has_profile_per_machine_; }

  /// The machine of a machine of the study or, without machines, of a trial.
  BoxPoint machine_of(std::int64_t unit) const;
  /// The nearest machine of the region on the way to the median.
  BoxPoint inside(BoxPoint point, MachineRegion region) const;
  bool is_likely(const BoxPoint& point) const;
  /// A trial of the machine with the random numbers `number`.
  trial::TrialParameters trial_of(const BoxPoint& point, std::int64_t number) const;

 private:
  bool is_row(std::size_t input) const { return inputs_[input].slots.size() > 1; }  // of joint samples
  double excess_of(const BoxPoint& point, MachineRegion region) const;
  void approach_median(BoxPoint& point, double divisor) const;
  study::GivenDraws draws_of(const BoxPoint& point, std::int64_t number) const;

  study::Study given_;
  std::int64_t point_;
  std::vector<study::MachineInput> inputs_;
  study::Study searched_;  ///< with independent draws, as many as are wanted
  std::vector<std::pair<std::size_t, const study::Value*>> profiles_;
  bool has_profile_per_machine_{false};
};

/// How the manifest of a machine is written.
struct MachineManifest {
  std::string condition{};                        ///< its name; empty: there is none
  std::optional<std::filesystem::path> folder{};  ///< from which the study's manifest names its files
  std::int64_t trials{0};                         ///< of the machine
};

/// The machines of the machine's manifest: more than one only where a profile belongs to a machine. The
/// machine is the last machine, and its trials are every machines_of_manifest()-th from there on.
std::int64_t machines_of_manifest(const MachineBox& box, const BoxPoint& point);

/// The manifest of a machine: values in place of their distributions, as they act at its age, and all else
/// as in the study.
/// @param values of the inputs of the machine, by their names
/// @throws Failure (bad_input) for a value with aging that is drawn anew for each contact, or once for all
/// machines
std::string manifest_of(const MachineBox& box, const BoxPoint& point,
                        const std::vector<std::pair<std::string, double>>& values,
                        const MachineManifest& manifest);

/// Values by the names of their parameters.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// The machine of a study that does worst.
struct WorstMachine {
  std::int64_t machine{0};  ///< or the trial, where no trials share a machine
  std::int64_t trial{0};    ///< its worst trial
  double met{0.0};          ///< proportion of its moves that meet the goal
  NamedValues inputs;
  /// The goal that it meets in the fewest of its moves, and the condition: of these trial and met are.
  ClaimPlace claim{};
  ClaimNames names{};
};

/// The machine with the fewest moves that meet a goal under a condition; of equal ones the one with the
/// largest criterion.
/// @param results of all units of the study
WorstMachine worst_machine(const study::Study& study, std::int64_t point,
                           std::span<const UnitResult> results);

/// A machine under a condition, and its manifest: values in place of their distributions, nothing drawn that
/// differs between machines, the overrides of the condition in the sections. It is judged by the trials of
/// that manifest, which neither the study nor a search has used.
struct JudgedMachine {
  std::int64_t condition{0};
  std::optional<std::string> condition_name{};  ///< without conditions none
  std::int64_t machine{0};            ///< of the study, from which it has its profiles; 0 without machines
  std::int64_t trial{0};              ///< its worst trial, of the manifest
  std::int64_t moves{0};              ///< by which it is judged
  double met{0.0};                    ///< proportion of these moves that meet all goals which ask them
  std::optional<std::string> goal{};  ///< of several goals the one that its moves meet the least often
  NamedValues inputs;
  std::vector<double> quantiles;  ///< [machine input] (study::machine_inputs)
  std::string manifest;           ///< empty if no manifest describes it
  std::string no_manifest;        ///< then: why
  /// Whether it is the same machine as the one before it of the answer: in the box as that of the study, of
  /// the likely ones as that in the box.
  bool is_previous{false};
};

/// The inputs of the machines of a point at the ends of the box, and their medians.
struct BoxEdges {
  NamedValues low, median, high;
};

/// The inputs that machines have at these quantiles, [machine input] (study::machine_inputs).
/// @param study under one condition
NamedValues values_at(const study::Study& study, std::int64_t point, std::span<const double> quantiles);

/// The worst machines of a point.
struct WorstMachines {
  WorstMachine of_study;  ///< by its trials in the study
  JudgedMachine again;    ///< the same machine, judged as the others are
  /// Of all whose drawn quantities are each within their central 99.9 %, or else of the study: its corners
  /// may be machines that nobody builds.
  JudgedMachine in_box;
  /// Of those of the box whose normal scores have Σ z² ≤ the 99.9 % quantile of χ², without correlations.
  JudgedMachine likely;
  bool with_profiles{false};  ///< the machines have profiles of their machines
  BoxEdges edges{};           ///< under the condition of in_box
};

/// Finds the machines with the fewest moves that meet the goals; of equal ones the one whose moves have the
/// larger score (measures::MoveScore::event, that of `rare` too). The search in the box begins at the worst
/// machines of the study, at the corners, and at points that fill the box. With conditions it is made under
/// each, and the answer is of the worst.
///
///     race of some machines, on the same random numbers: 4 trials each; a quarter goes on to 16, of it a
///       quarter to 64 trials; the 8 worst are kept
///     population = race of the first machines
///     8 times: population = race of it and of 32 children, each near a machine of the population; a child
///       goes on only while it does worse than one of the population on the same trials
///     likely machines: only where a machine of the box misses a move
///     the worst is judged by 256 trials of its own
///
/// @param folder from which the study's manifest names its files; none if it is not a file
/// @throws trial::Interrupted, trials::Spent; Failure (bad_input) if the study draws nothing that differs
/// between machines
WorstMachines worst_machines(const study::Study& study, const trials::Replicates& units,
                             const std::optional<std::filesystem::path>& folder,
                             const trials::Effort& effort);

/// Trials that worst_machines() runs, about.
std::int64_t trials_of_worst_machines(const study::Study& study, const trials::Replicates& units);

/// Why no manifest can describe a machine of the point at its age: a value with `aging` is drawn per contact
/// or per study. Empty if it can.
std::string refusal_of_manifests(const study::Study& study, std::int64_t point);

}  // namespace zerocount::tuning

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// The machine of a study that does worst.
struct WorstMachine {
  std::int64_t rig{0};    ///< or the trial, where no trials share a rig
  std::int64_t trial{0};  ///< its worst trial
  double met{0.0};        ///< proportion of its moves that meet the goal
  std::vector<std::pair<std::string, double>> inputs;
  /// The goal that it meets in the fewest of its moves, and the condition: of these trial and met are.
  ClaimPlace claim{};
  std::optional<std::string> goal{}, condition{};  ///< their names; of one goal, and without conditions none
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
  std::int64_t rig{0};                ///< of the study, from which it has its profiles; 0 without rigs
  std::int64_t trial{0};              ///< its worst trial, of the manifest
  std::int64_t moves{0};              ///< by which it is judged
  double met{0.0};                    ///< proportion of these moves that meet all goals which ask them
  std::optional<std::string> goal{};  ///< of several goals the one that its moves meet the least often
  std::vector<std::pair<std::string, double>> inputs;
  std::vector<double> quantiles;  ///< [machine input] (study::machine_inputs)
  std::string manifest;           ///< empty if no manifest describes it
  std::string no_manifest;        ///< then: why

  bool is_same_machine(const JudgedMachine& other) const {
    return condition == other.condition && rig == other.rig && quantiles == other.quantiles;
  }
};

/// The worst machines of a point.
struct WorstMachines {
  WorstMachine of_study;  ///< by its trials in the study
  JudgedMachine again;    ///< the same machine, judged as the others are
  /// Of all whose drawn quantities are each within their central 99.9 %, or else of the study: its corners
  /// may be machines that nobody builds.
  JudgedMachine in_box;
  /// Of those of the box whose normal scores have Σ z² ≤ the 99.9 % quantile of χ², without correlations.
  JudgedMachine likely;
  bool with_profiles{false};  ///< the machines have profiles of their rigs

  bool in_box_is_of_study() const { return in_box.is_same_machine(again); }
  bool likely_is_in_box() const { return likely.is_same_machine(in_box); }
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

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/trials/effort.hpp"
#include "runners/tuning/worst_machines/machine_failures.hpp"
#include "runners/tuning/worst_machines/machine_manifest.hpp"

namespace zerocount::tuning {

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
};

/// Judges a machine by the trials of its manifest.
/// @throws trial::Interrupted, trials::Spent
JudgedMachine judged(const BoxPoint& point, const MachineBox& box, const MachineFailures& failures,
                     const MachineManifest& manifest, const trials::Effort& effort);

}  // namespace zerocount::tuning

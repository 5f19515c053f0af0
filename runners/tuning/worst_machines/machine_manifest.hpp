#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/worst_machines/machine_box.hpp"

namespace zerocount::tuning {

/// How the manifest of a machine is written.
struct MachineManifest {
  std::string condition{};                        ///< its name; empty: there is none
  std::optional<std::filesystem::path> folder{};  ///< from which the study's manifest names its files
  std::int64_t trials{0};                         ///< of the machine
};

/// The rigs of the machine's manifest: more than one only where a profile belongs to a rig. The machine is
/// the last rig, and its trials are every rigs_of_manifest()-th from there on.
std::int64_t rigs_of_manifest(const MachineBox& box, const BoxPoint& point);

/// The manifest of a machine: values in place of their distributions, as they act at its age, and all else
/// as in the study.
/// @param values of the inputs of the machine, by their names
/// @throws Failure (bad_input) for a value with aging that is drawn anew for each contact, or once for all
/// machines
std::string manifest_of(const MachineBox& box, const BoxPoint& point,
                        const std::vector<std::pair<std::string, double>>& values,
                        const MachineManifest& manifest);

/// Why no manifest can describe a machine of the point at its age: a value with `aging` is drawn per contact
/// or per study. Empty if it can.
std::string refusal_of_manifests(const study::Study& study, std::int64_t point);

}  // namespace zerocount::tuning

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/machine_inputs.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/race/candidate.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// A machine: a rig, and [machine input] the quantile that it has.
struct BoxPoint {
  std::int64_t rig{0};
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
  bool has_profile_per_rig() const { return has_profile_per_rig_; }

  /// The machine of a rig of the study or, without rigs, of a trial.
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
  bool has_profile_per_rig_{false};
};

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

}  // namespace zerocount::tuning

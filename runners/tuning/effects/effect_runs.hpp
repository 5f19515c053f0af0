#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/study/point_edit.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// An effect of a real axis, and a study without it, or with it added.
struct Effect {
  std::string name;
  std::string note{};     ///< what is assumed, or what the rate does not show
  std::string refusal{};  ///< why it cannot be simulated; empty if it can
  /// The values to change, those that belong to them included; empty: none.
  std::function<void(study::PointEdit&)> edit{};
  Change change{};  ///< of what a trial has drawn; empty: none
};

/// The effects of one name, under each condition that has it.
struct ConditionEffects {
  std::string name;
  std::vector<std::optional<Effect>> under;  ///< [condition]
};

/// A point with some effects switched off or added, and what its first units do.
struct ChangedPoint {
  std::string name;                   ///< of the effects, joined by "and"; "none"
  std::string note;                   ///< of the first effect that has one
  std::string refusal;                ///< why it cannot be simulated; empty if it can
  std::vector<study::Study> studies;  ///< [condition]
  std::vector<Change> changes;        ///< [condition], after the trials of these studies are drawn
  Candidate run;                      ///< its units so far, with all goals under all conditions
};

/// Runs a point with effects switched off or added on the random numbers of the study, each condition as a
/// study of its own.
class EffectRuns {
 public:
  /// Runs the point as it is.
  /// @throws trial::Interrupted, trials::Spent
  EffectRuns(const study::Study& study, const trials::Replicates& units, trials::Effort effort);

  const study::Study& study() const { return study_; }
  const Aim& aim() const { return aim_; }
  std::int64_t point() const { return units_.point; }
  /// Units of the study, and trials of each under one condition.
  std::int64_t units() const { return units_.count; }
  std::int64_t trials_each() const { return units_.trials_each; }
  const std::vector<study::Study>& conditions() const { return conditions_; }
  const trials::Effort& effort() const { return effort_; }
  /// The point as it is, with the results of all units.
  const ChangedPoint& base() const { return base_; }

  /// What `effects_of(study under a condition, point)` says of each condition, by name.
  std::vector<ConditionEffects> effects(
      const std::function<std::vector<Effect>(const study::Study&, std::int64_t)>& effects_of) const;

  /// The point with these effects changed, of which nothing has run. Where the manifest could not describe
  /// it, its refusal says why.
  ChangedPoint changed(std::span<const ConditionEffects* const> together) const;

  /// Runs the units of each point up to `count`, all of them in one go, and passes over points that cannot be
  /// simulated.
  /// @throws trial::Interrupted, trials::Spent
  void run(std::span<ChangedPoint> points, std::int64_t count) const;

 private:
  void run_all(std::span<ChangedPoint> points, std::int64_t count) const;

  const study::Study& study_;
  Aim aim_;
  trials::Replicates units_;  ///< of each condition
  trials::Effort effort_;
  std::vector<study::Study> conditions_;
  ChangedPoint base_;
};

}  // namespace zerocount::tuning

#pragma once

#include <string>
#include <vector>

#include "core/theory/frozen_loop.hpp"
#include "core/trial/parameters.hpp"

/// Linear loops that approximate a trial at rest and while its rotor slides.
namespace zerocount::theory {

/// Whether the loop is open, or the controller a plugin, whose transfer function is not known.
bool has_no_linear_loop(const trial::TrialParameters& parameters);

/// Whether criteria (6) and (7) do not apply to this trial, because its loop is not linear about a
/// pre-sliding spring. It is equal in all trials of a point.
bool is_outside_theory(const trial::TrialParameters& parameters);

/// Why it is outside: "the loop is open", …; empty if it is not.
std::string why_outside_theory(const trial::TrialParameters& parameters);

/// The linear model of the trial's converter and amplifier.
LinearDrive drive_of(const trial::TrialParameters& parameters);

/// A loop of a trial with its friction frozen.
struct TrialLoop {
  std::string name;       ///< "at k1", "at k1 + k2", "while sliding", "while sliding, the fine phase", …
  bool slides{false};     ///< there is no spring
  double stiffness{0.0};  ///< of the spring, N m/rad
  FrozenLoop loop;
};

/// The loop in the fine phase about each stiffness of the contact at the start, then each phase of the
/// control while the rotor slides. Empty if has_no_linear_loop().
std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters);

}  // namespace zerocount::theory

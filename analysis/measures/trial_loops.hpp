#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/theory/frozen_loop.hpp"
#include "core/trial/parameters.hpp"

/// The linear loops of a trial that stand for its contact and its sliding.
namespace zerocount::measures {

/// Why no linear loop about a pre-sliding spring stands for this trial: "the loop is open", …; empty where
/// one does. The form of the command and the friction model, which decide it, are the same in all trials of a
/// point.
std::string_view why_outside_theory(const trial::TrialParameters& parameters);

/// The linear model of the trial's converter and amplifier.
theory::LinearDrive drive_of(const trial::TrialParameters& parameters);

/// A loop of a trial with its friction frozen.
struct TrialLoop {
  std::string name;       ///< "at k1", "at k1 + k2", "while sliding", "while sliding, the fine phase", …
  bool slides{false};     ///< there is no spring
  double stiffness{0.0};  ///< of the spring, N m/rad
  theory::FrozenLoop loop;
};

/// The loop in the fine phase about the springs that stand for the contact at the start, and each phase of
/// the control while the rotor slides. Empty where the loop is open, or the controller is a plugin.
std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters);

}  // namespace zerocount::measures

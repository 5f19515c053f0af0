#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/friction/linear_contact.hpp"
#include "core/loop/parameters.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/trial/parameters.hpp"

/// The linear control loops of a machine with its friction frozen (replaced by a constant spring and
/// damping): one for each contact of the motor, each state of the load and each control. All that judges
/// loops takes them from here.
// Beside theory_prediction.hpp, which many include: the loop brings Eigen's matrices.
namespace zerocount::theory {

// Names of the contacts at the ends of a friction profile.
inline constexpr std::string_view at_softest = "at the softest place of the profile";
inline constexpr std::string_view at_stiffest = "at the stiffest place of the profile";

/// The linear contacts that approximate the motor's friction: at the start of the trial; if the spring
/// stiffness varies along the axis, also where it is softest and stiffest.
friction::LinearContacts linear_contacts_of(const trial::TrialParameters& parameters);

/// The lowest k1 and the highest k1 + k2 (contact stiffness) along the axis in a trial, N m/rad.
std::pair<double, double> stiffness_range(const trial::TrialParameters& parameters);

/// State of the second mass (load) for which a loop of its own is examined.
struct LoadState {
  /// Name of the state: ", the load stands", …; empty if the masses move together, or there is only one.
  std::string name;
  bool motor_alone{false};    ///< True if the motor moves and the load does not.
  FrozenFriction friction{};  ///< Friction of the load that is added to the friction of the motor.
};

/// The states of the second mass (load) of a trial for which loops are examined:
///
///     gap closed   without friction of the load: both masses move together
///                  coulomb: the load slides, or stands, so that the coupling holds the motor
///                  dahl, lugre: the load slides, or is held by its bristles
///     gap open     the motor moves alone
std::vector<LoadState> load_states(const trial::TrialParameters& parameters);

/// A linear control loop of a trial with its friction frozen (a constant spring and damping).
struct TrialLoop {
  std::string name;       ///< "at k1", "while sliding, the fine phase", "at k1, the load stands", …
  bool slides{false};     ///< True if the motor slides, so that its contact has no spring.
  double stiffness{0.0};  ///< Stiffness of the motor's friction contact, N m/rad; 0 if it slides.
  FrozenLoop loop;
  loop::ControlPhase phase{loop::ControlPhase::fine};
  /// Index, in load_states(), of the state of the load for which the loop holds.
  std::size_t load{0};
};

/// The linear loops about each of these friction contacts of the motor, in each state of the load. In the
/// fine phase there are loops with the gains of motion and with the gains at standstill. A contact that
/// slides also has the loop of the coarse phase. A state that cuts the loop has none. Empty if
/// has_no_linear_loop().
std::vector<TrialLoop> loops_about(const friction::LinearContacts& contacts,
                                   const trial::TrialParameters& parameters);

/// The linear loops about each of linear_contacts_of(): before sliding, then while sliding.
std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters);

/// Names of the states of the load in which the motor moves alone and the controller reads no encoder on the
/// motor, so that the loop is cut.
std::vector<std::string> states_without_loop(const trial::TrialParameters& parameters);

/// The linear loop about a contact in a state of the load with the given controller; nothing if the loop is
/// cut in that state.
std::optional<FrozenLoop> loop_in_state(const friction::LinearContact& contact, const LoadState& state,
                                        const trial::TrialParameters& parameters,
                                        const loop::ControllerParameters& controller);

}  // namespace zerocount::theory

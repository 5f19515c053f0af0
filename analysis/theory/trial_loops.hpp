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

/// The loops in which a machine moves, with its friction frozen: one for each contact of the motor, each
/// state of the load and each control. All that judges loops takes them from here.
// Beside theory_prediction.hpp, which many include: the loop brings Eigen's matrices.
namespace zerocount::theory {

// Names of the contacts at the ends of a friction profile.
inline constexpr std::string_view at_softest = "at the softest place of the profile";
inline constexpr std::string_view at_stiffest = "at the stiffest place of the profile";

/// The contacts that approximate the motor's friction: at the start of the trial; of a spring with a profile
/// also where it is softest and stiffest.
friction::LinearContacts linear_contacts_of(const trial::TrialParameters& parameters);

/// The lowest k1 and the highest k1 + k2 over the friction profile of a trial, N m/rad.
std::pair<double, double> stiffness_range(const trial::TrialParameters& parameters);

/// State of the second mass that makes a loop of its own.
struct LoadState {
  std::string name;           ///< ", the load stands", …; empty: the masses move together, or there is one
  bool motor_alone{false};    ///< The motor moves and the load does not.
  FrozenFriction friction{};  ///< Friction of the load that is added to the friction of the motor.
};

/// The states of the second mass of a trial:
///
///     gap closed   without friction of the load: both masses move together
///                  coulomb: the load slides, or stands, so that the coupling holds the motor
///                  dahl, lugre: the load slides, or is held by its bristles
///     gap open     the motor moves alone
std::vector<LoadState> load_states(const trial::TrialParameters& parameters);

/// A loop of a trial with its friction frozen.
struct TrialLoop {
  std::string name;       ///< "at k1", "while sliding, the fine phase", "at k1, the load stands", …
  bool slides{false};     ///< The motor's contact has no spring.
  double stiffness{0.0};  ///< Stiffness of the motor's contact, N m/rad.
  FrozenLoop loop;
  loop::ControlPhase phase{loop::ControlPhase::fine};
  std::size_t load{0};  ///< Index of the load's state in load_states().
};

/// The loops about each of these contacts of the motor, in each state of the load. In the fine phase there
/// are loops with the gains of motion and with the gains at standstill. A contact that slides also has the
/// loop of the coarse phase. A state that cuts the loop has none. Empty if has_no_linear_loop().
std::vector<TrialLoop> loops_about(const friction::LinearContacts& contacts,
                                   const trial::TrialParameters& parameters);

/// The loops about each of linear_contacts_of(): before sliding, then while sliding.
std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters);

/// Names of the states of the load in which the motor moves alone and the controller reads no encoder on the
/// motor, so that the loop is cut.
std::vector<std::string> states_without_loop(const trial::TrialParameters& parameters);

/// The loop about a contact in a state of the load with the given control; nothing if the loop is cut in that
/// state.
std::optional<FrozenLoop> loop_in_state(const friction::LinearContact& contact, const LoadState& state,
                                        const trial::TrialParameters& parameters,
                                        const loop::ControllerParameters& controller);

}  // namespace zerocount::theory

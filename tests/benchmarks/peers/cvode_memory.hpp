#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

#include "tests/benchmarks/peers/contact.hpp"

namespace zerocount::testing {

enum class CvodeMethod { adams, bdf };
enum class CvodeSolver { fixed_point, newton };

/// How exactly CVODE integrates. tests/benchmarks/peers.md says how these were chosen.
struct CvodeSettings {
  CvodeMethod method{CvodeMethod::adams};
  CvodeSolver solver{CvodeSolver::fixed_point};
  double tolerance{3e-14};       ///< local error of a step (root mean square over the state), rad
  double after_breakaway{30.0};  ///< by how much it is larger after the first breakaway
  double rest{8e-13};            ///< ε of the rest rule, rad
  bool pass_samples{true};  ///< steps go on past a sampling instant where the torque has stood for a sample
};

/// What CVODE integrates: the system behind its callbacks.
class CvodeSystem {
 public:
  CvodeSystem(const trial::TrialParameters& parameters, const CvodeSettings& settings)
      : contact_(parameters, settings.rest), settings_(settings) {}

  const PeerContact& contact() const { return contact_; }
  PeerContact& contact() { return contact_; }
  double tolerance() const {
    return contact_.breakaways() > 0 ? settings_.after_breakaway * settings_.tolerance : settings_.tolerance;
  }
  /// Where a slide slows down and its Stribeck peak is not yet in sight, that is watched for.
  bool nears_peak{false};

 private:
  PeerContact contact_;
  CvodeSettings settings_;
};

/// The events in the order of CVODE's root functions. While the hook slides, the last is the stop, and none
/// the coming into sight of the Stribeck peak, which only restarts the integration.
inline constexpr std::array cvode_events{PeerEvent::closure, PeerEvent::creep, PeerEvent::breakaway,
                                         PeerEvent::reversal};
using CvodeGuards = std::array<double, cvode_events.size()>;

/// The guards of `cvode_events` at the state y.
CvodeGuards cvode_guards(const CvodeSystem& system, const PeerState& y);

/// CVODE's memory, which takes any number of trials one after the other. For one thread.
class CvodeMemory {
 public:
  explicit CvodeMemory(const CvodeSettings& settings);
  ~CvodeMemory();
  CvodeMemory(const CvodeMemory&) = delete;
  CvodeMemory& operator=(const CvodeMemory&) = delete;
  CvodeMemory(CvodeMemory&&) = delete;
  CvodeMemory& operator=(CvodeMemory&&) = delete;

  const CvodeSettings& settings() const { return settings_; }
  void* cvode() { return cvode_; }
  N_Vector state() { return state_; }

 private:
  CvodeSettings settings_;
  SUNContext context_{nullptr};
  N_Vector state_{nullptr};
  SUNMatrix matrix_{nullptr};
  SUNLinearSolver linear_{nullptr};
  SUNNonlinearSolver nonlinear_{nullptr};
  void* cvode_{nullptr};
};

/// The values of a vector of CVODE.
PeerState cvode_state(N_Vector y);

/// @throws std::runtime_error where `flag`, which CVODE's function `what` returned, says that it failed.
void require_success(int flag, const char* what);

}  // namespace zerocount::testing

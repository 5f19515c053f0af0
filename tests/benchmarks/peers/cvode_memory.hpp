#pragma once

#include <sundials/sundials_context.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

#include "tests/benchmarks/peers/contact.hpp"

namespace zerocount::testing {

/// The system that CVODE integrates, used by its callbacks.
class CvodeSystem {
 public:
  explicit CvodeSystem(const trial::TrialParameters& parameters) : contact_(parameters) {}

  const PeerContact& contact() const { return contact_; }
  PeerContact& contact() { return contact_; }
  /// Tolerance of the local error of a step, root mean square over the state, rad.
  double tolerance() const { return contact_.breakaways() > 0 ? tolerance_after_breakaway * 3e-14 : 3e-14; }
  /// The contact slides and slows down, but is still too fast for its Stribeck peak to matter. CVODE then
  /// watches for the velocity at which the peak matters.
  bool nears_peak{false};

 private:
  PeerContact contact_;
};

/// The events in the order of CVODE's root functions. While the contact slides, the last one is the stop, and
/// `none` is the velocity at which the Stribeck peak begins to matter, which only restarts the integration.
inline constexpr std::array cvode_events{PeerEvent::closure, PeerEvent::creep, PeerEvent::breakaway,
                                         PeerEvent::reversal};
using CvodeGuards = std::array<double, cvode_events.size()>;

/// The guards of `cvode_events` at the state y: each is positive before its event.
CvodeGuards cvode_guards(const CvodeSystem& system, const PeerState& y);

/// CVODE's memory, which takes any number of trials one after the other. For one thread.
class CvodeMemory {
 public:
  CvodeMemory();
  ~CvodeMemory();
  CvodeMemory(const CvodeMemory&) = delete;
  CvodeMemory& operator=(const CvodeMemory&) = delete;
  CvodeMemory(CvodeMemory&&) = delete;
  CvodeMemory& operator=(CvodeMemory&&) = delete;

  void* cvode() { return cvode_; }
  N_Vector state() { return state_; }

 private:
  SUNContext context_{nullptr};
  N_Vector state_{nullptr};
  SUNNonlinearSolver nonlinear_{nullptr};
  void* cvode_{nullptr};
};

/// The state in a vector of CVODE.
PeerState cvode_state(N_Vector y);

/// Throws if a function of CVODE failed.
/// @param flag value that the function returned
/// @param what name of the function
/// @throws std::runtime_error if `flag` says that it failed
void require_success(int flag, const char* what);

}  // namespace zerocount::testing

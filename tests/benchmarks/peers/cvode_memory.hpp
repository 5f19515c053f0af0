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
  /// Local error of a step, root mean square over the state, rad.
  double tolerance() const { return contact_.breakaways() > 0 ? tolerance_after_breakaway * 3e-14 : 3e-14; }
  /// A slide slows down, and its Stribeck peak is not in sight yet: CVODE watches for its coming into sight.
  bool nears_peak{false};

 private:
  PeerContact contact_;
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

/// The values of a vector of CVODE.
PeerState cvode_state(N_Vector y);

/// @throws std::runtime_error where `flag`, which CVODE's function `what` returned, says that it failed.
void require_success(int flag, const char* what);

}  // namespace zerocount::testing

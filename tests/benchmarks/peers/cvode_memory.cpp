#include "tests/benchmarks/peers/cvode_memory.hpp"

#include <stdexcept>
#include <string>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace zerocount::testing {
namespace {

constexpr sunindextype size = std::tuple_size_v<PeerState>;
constexpr long max_steps = 1000000;  // between two samples

const CvodeSystem& system_of(void* user) {
  return *static_cast<const CvodeSystem*>(user);
}

int slopes(realtype time, N_Vector y, N_Vector slope, void* user) {
  PeerState result;
  system_of(user).contact().law()(cvode_state(y), result, time);
  std::copy(result.begin(), result.end(), NV_DATA_S(slope));
  return 0;
}

int roots(realtype /*time*/, N_Vector y, realtype* values, void* user) {
  const CvodeGuards guards = cvode_guards(system_of(user), cvode_state(y));
  std::copy(guards.begin(), guards.end(), values);
  return 0;
}

/// CVODE's error weights: the tolerance is one length (rad) for all components of the state.
int weights(N_Vector /*y*/, N_Vector weight, void* user) {
  std::fill_n(NV_DATA_S(weight), size, 1.0 / system_of(user).tolerance());
  return 0;
}

/// Error handler that prints nothing: the flags that CVODE returns report all errors.
void silent(int /*code*/, const char* /*module*/, const char* /*function*/, char* /*message*/,
            void* /*user*/) {}

}  // namespace

PeerState cvode_state(N_Vector y) {
  const realtype* values = NV_DATA_S(y);
  return {values[0], values[1], values[2]};
}

void require_success(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string(what) + " failed with the flag " + std::to_string(flag));
}

CvodeGuards cvode_guards(const CvodeSystem& system, const PeerState& y) {
  const PeerContact& contact = system.contact();
  if (contact.sliding()) {
    const double speed = contact.stop_guard(y);
    return {1.0, 1.0, system.nears_peak ? speed - contact.peak_in_sight() : 1.0, speed};
  }
  const PeerMotionLaw& law = contact.law();
  const double sigma = law.spring_torque(y[0]);
  const double omega = contact.omega(y);
  PeerState rate{omega, 0.0, 0.0};
  if (law.alpha != 0.0) rate[0] -= law.side * law.alpha * (law.hardening_limit(sigma) - y[2]);
  return {std::min(contact.closure_guard(y[0]), 1.0), std::min(contact.creep_guard(sigma, y[2]), 1.0),
          contact.breakaway_guard(sigma + law.damping * omega, y), contact.reversal_guard(rate)};
}

CvodeMemory::CvodeMemory() {
  require_success(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
  state_ = N_VNew_Serial(size, context_);
  require_success(N_VEnableFusedOps_Serial(state_, SUNTRUE), "N_VEnableFusedOps_Serial");
  N_VConst(0.0, state_);
  cvode_ = CVodeCreate(CV_ADAMS, context_);
  require_success(CVodeSetErrHandlerFn(cvode_, silent, nullptr), "CVodeSetErrHandlerFn");
  require_success(CVodeInit(cvode_, slopes, 0.0, state_), "CVodeInit");
  require_success(CVodeWFtolerances(cvode_, weights), "CVodeWFtolerances");
  require_success(CVodeSetMaxNumSteps(cvode_, max_steps), "CVodeSetMaxNumSteps");
  nonlinear_ = SUNNonlinSol_FixedPoint(state_, 0, context_);
  require_success(CVodeSetNonlinearSolver(cvode_, nonlinear_), "CVodeSetNonlinearSolver");
  require_success(CVodeRootInit(cvode_, static_cast<int>(cvode_events.size()), roots), "CVodeRootInit");
  std::array<int, cvode_events.size()> falling;
  falling.fill(-1);
  require_success(CVodeSetRootDirection(cvode_, falling.data()), "CVodeSetRootDirection");
  require_success(CVodeSetNoInactiveRootWarn(cvode_), "CVodeSetNoInactiveRootWarn");
}

CvodeMemory::~CvodeMemory() {
  CVodeFree(&cvode_);
  SUNNonlinSolFree(nonlinear_);
  N_VDestroy(state_);
  SUNContext_Free(&context_);
}

}  // namespace zerocount::testing

#include "tests/benchmarks/peers/cvode_memory.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
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

/// The tolerance is one length for all of the state.
int weights(N_Vector /*y*/, N_Vector weight, void* user) {
  std::fill_n(NV_DATA_S(weight), size, 1.0 / system_of(user).tolerance());
  return 0;
}

int jacobian(realtype /*time*/, N_Vector y, N_Vector /*slope*/, SUNMatrix matrix, void* user, N_Vector,
             N_Vector, N_Vector) {
  const PeerMotionLaw& law = system_of(user).contact().law();
  const PeerState state = cvode_state(y);
  realtype** column = SUNDenseMatrix_Cols(matrix);
  column[1][0] = law.per_tau;
  column[1][1] = -law.damping * law.per_tau * law.tau_per_inertia;
  if (law.sliding) {
    const double w = state[1] * law.softening_rate;
    const double falling = 2.0 * law.softening_torque * law.softening_rate * w * std::exp(-w * w);
    column[1][1] += law.sign * falling * law.tau_per_inertia;
    return 0;
  }
  const double sigma = law.spring_torque(state[0]);
  const double stiffness = law.stiffness(law.softness);
  column[0][1] = -stiffness * law.tau_per_inertia;
  if (law.alpha == 0.0) return 0;
  const double growth = law.alpha * law.n * law.hardening_limit(sigma) / sigma * stiffness;
  column[0][0] = -law.side * growth;
  column[0][2] = growth;
  column[2][0] = law.side * law.alpha;
  column[2][2] = -law.alpha;
  return 0;
}

/// What CVODE has to say comes as the flags that it returns.
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

CvodeMemory::CvodeMemory(const CvodeSettings& settings) : settings_(settings) {
  require_success(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
  state_ = N_VNew_Serial(size, context_);
  require_success(N_VEnableFusedOps_Serial(state_, SUNTRUE), "N_VEnableFusedOps_Serial");
  N_VConst(0.0, state_);
  cvode_ = CVodeCreate(settings.method == CvodeMethod::adams ? CV_ADAMS : CV_BDF, context_);
  require_success(CVodeSetErrHandlerFn(cvode_, silent, nullptr), "CVodeSetErrHandlerFn");
  require_success(CVodeInit(cvode_, slopes, 0.0, state_), "CVodeInit");
  require_success(CVodeWFtolerances(cvode_, weights), "CVodeWFtolerances");
  require_success(CVodeSetMaxNumSteps(cvode_, max_steps), "CVodeSetMaxNumSteps");
  if (settings.solver == CvodeSolver::fixed_point) {
    nonlinear_ = SUNNonlinSol_FixedPoint(state_, 0, context_);
    require_success(CVodeSetNonlinearSolver(cvode_, nonlinear_), "CVodeSetNonlinearSolver");
  } else {
    matrix_ = SUNDenseMatrix(size, size, context_);
    linear_ = SUNLinSol_Dense(state_, matrix_, context_);
    require_success(CVodeSetLinearSolver(cvode_, linear_, matrix_), "CVodeSetLinearSolver");
    require_success(CVodeSetJacFn(cvode_, jacobian), "CVodeSetJacFn");
  }
  require_success(CVodeRootInit(cvode_, static_cast<int>(cvode_events.size()), roots), "CVodeRootInit");
  std::array<int, cvode_events.size()> falling;
  falling.fill(-1);
  require_success(CVodeSetRootDirection(cvode_, falling.data()), "CVodeSetRootDirection");
  require_success(CVodeSetNoInactiveRootWarn(cvode_), "CVodeSetNoInactiveRootWarn");
}

CvodeMemory::~CvodeMemory() {
  CVodeFree(&cvode_);
  if (nonlinear_ != nullptr) SUNNonlinSolFree(nonlinear_);
  if (linear_ != nullptr) SUNLinSolFree(linear_);
  if (matrix_ != nullptr) SUNMatDestroy(matrix_);
  N_VDestroy(state_);
  SUNContext_Free(&context_);
}

}  // namespace zerocount::testing

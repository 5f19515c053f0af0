#include "tests/benchmarks/peers/cvode_plant.hpp"

#include <cstdint>
#include <stdexcept>

#include <boost/math/tools/toms748_solve.hpp>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>

namespace zerocount::testing {
namespace {

constexpr int max_events = 100000;  // between two samples
constexpr int bits_of_event_time = 40;
constexpr double no_stop = 1e30;         // s: later than any sample
constexpr double no_longest_step = 0.0;  // as CVODE has it

}  // namespace

CvodePlant::CvodePlant(const trial::TrialParameters& p, CvodeMemory& memory)
    : system_(p), memory_(memory), now_(contact().start()) {
  require_success(CVodeSetUserData(memory_.cvode(), &system_), "CVodeSetUserData");
  restart();
}

void CvodePlant::set_torque(double torque) {
  stood_ = torque == contact().law().torque;
  if (stood_) return;
  contact().set_torque(torque);
  restart();
}

/// Restarts the integration from the present state with the present torque and contact. CVODE's history is
/// discarded.
void CvodePlant::restart() {
  contact().begin(now_);
  clock_ = 0.0;
  if (contact().resting()) return;
  limit_step();
  std::copy(now_.begin(), now_.end(), NV_DATA_S(memory_.state()));
  require_success(CVodeReInit(memory_.cvode(), 0.0, memory_.state()), "CVodeReInit");
}

void CvodePlant::limit_step() {
  double longest = no_longest_step;
  system_.nears_peak = false;
  if (contact().sliding()) {
    PeerState slope;
    contact().law()(now_, slope, 0.0);
    if (contact().slows_down(slope)) {
      system_.nears_peak = std::abs(now_[1]) > 1.001 * contact().peak_in_sight();
      if (!system_.nears_peak) longest = contact().longest_step_over_peak();
    }
  }
  require_success(CVodeSetMaxStep(memory_.cvode(), longest), "CVodeSetMaxStep");
}

void CvodePlant::advance(double duration) {
  double until = clock_ + duration;
  for (int i = 0; i < max_events; ++i) {
    if (contact().resting()) {
      contact().hold(now_, until - clock_);
      return restart();
    }
    // Where the torque has stood for a sample, steps go on past the sampling instant.
    require_success(CVodeSetStopTime(memory_.cvode(), stood_ ? no_stop : until), "CVodeSetStopTime");
    double time = clock_;
    const int flag = CVode(memory_.cvode(), until, memory_.state(), &time, CV_NORMAL);
    require_success(flag, "CVode");
    now_ = cvode_state(memory_.state());
    clock_ = time;
    if (flag == CV_ROOT_RETURN) {
      const PeerEvent event = earliest_event();
      until -= clock_;
      contact().happen(event, now_);
      restart();
    } else if (time >= until) {
      return;
    }
  }
  throw std::runtime_error("CvodePlant: events without end");
}

/// The event at the root that CVODE has come to, or an earlier event in the same step. CVODE does not see an
/// earlier event if another one undoes it within the step, as a reversal does with a closure just before it.
PeerEvent CvodePlant::earliest_event() {
  std::array<int, cvode_events.size()> found{};
  require_success(CVodeGetRootInfo(memory_.cvode(), found.data()), "CVodeGetRootInfo");
  double step = 0.0;
  double step_end = 0.0;
  require_success(CVodeGetLastStep(memory_.cvode(), &step), "CVodeGetLastStep");
  require_success(CVodeGetCurrentTime(memory_.cvode(), &step_end), "CVodeGetCurrentTime");
  const double step_start = std::max(step_end - step, 0.0);
  const auto guards_at = [&](double time) {
    require_success(CVodeGetDky(memory_.cvode(), time, 0, memory_.state()), "CVodeGetDky");
    return cvode_guards(system_, cvode_state(memory_.state()));
  };
  std::size_t first = 0;
  while (first + 1 < found.size() && found[first] == 0) ++first;
  const CvodeGuards at_start = guards_at(step_start);
  CvodeGuards at_end = cvode_guards(system_, now_);
  for (std::size_t i = 0; i < cvode_events.size(); ++i) {
    if (found[i] != 0 || !(at_start[i] > 0.0 && at_end[i] < 0.0)) continue;
    std::uintmax_t iterations = 60;
    clock_ = boost::math::tools::toms748_solve(
                 [&](double time) { return guards_at(time)[i]; }, step_start, clock_, at_start[i], at_end[i],
                 boost::math::tools::eps_tolerance<double>(bits_of_event_time), iterations)
                 .second;
    at_end = guards_at(clock_);
    now_ = cvode_state(memory_.state());
    first = i;
  }
  if (!contact().sliding()) return cvode_events[first];
  return cvode_events[first] == PeerEvent::reversal ? PeerEvent::stop : PeerEvent::none;
}

}  // namespace zerocount::testing

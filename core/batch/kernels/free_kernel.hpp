#pragma once

#include "core/batch/kernels/lane_group.hpp"

namespace zerocount::batch {

/// Moves each lane without friction to its next stop, one sample ahead, by the linear map of
/// friction::free_motion. With `Varies` the torque is CourseLanes::settled and a lag.
template <class V, bool Varies>
void free_kernel(BatchState& batch, const LaneSet& lanes) {
  for_each_stretch<V>(lanes, [&]<class At>(const At& at) {
    using P = typename At::Vector;
    MotionLanes& m = batch.motion;
    const FreeLanes& f = batch.free;
    const P omega = at.load(m.omega);
    const P torque = at.load(Varies ? batch.course.settled : m.torque);
    P theta = at.load(m.theta) + (omega * at.load(f.travel) + torque * at.load(f.push));
    P velocity = omega * at.load(f.decay) + torque * at.load(f.gain);
    if constexpr (Varies) {
      const P lag = at.load(batch.course.lag);
      theta = theta + lag * at.load(f.lag_push);
      velocity = velocity + lag * at.load(f.lag_gain);
    }
    at.store(m.theta, theta);
    at.store(m.omega, velocity);
    at.store(batch.time.time_to_stop, P(0.0));
  });
}

}  // namespace zerocount::batch

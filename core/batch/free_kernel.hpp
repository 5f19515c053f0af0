#pragma once

#include "core/batch/lane_group.hpp"

namespace zerocount::batch {

/// Moves each lane without friction to its next stop, one sample ahead, by the linear map of
/// friction::free_motion.
template <class V>
void free_kernel(BatchState& batch, const LaneSet& lanes) {
  for_each_stretch<V>(lanes, [&]<class At>(const At& at) {
    using P = typename At::Vector;
    MotionLanes& m = batch.motion;
    const FreeLanes& f = batch.free;
    const P omega = at.load(m.omega);
    const P torque = at.load(m.torque);
    at.store(m.theta, at.load(m.theta) + (omega * at.load(f.travel) + torque * at.load(f.push)));
    at.store(m.omega, omega * at.load(f.decay) + torque * at.load(f.gain));
    at.store(batch.time.time_to_stop, P(0.0));
  });
}

}  // namespace zerocount::batch

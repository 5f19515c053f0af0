#pragma once

#include "core/batch/kernels/applied_torque.hpp"
#include "core/batch/kernels/bristle_kernel.hpp"
#include "core/batch/kernels/free_kernel.hpp"
#include "core/batch/kernels/kernels.hpp"
#include "core/batch/kernels/lane_sets_kernel.hpp"
#include "core/batch/kernels/sample_kernel.hpp"
#include "core/batch/kernels/slide_kernel.hpp"
#include "core/batch/kernels/stick_start_kernel.hpp"
#include "core/batch/kernels/stick_step_kernel.hpp"

namespace zerocount::batch {

template <class V, class E, bool Varies>
inline constexpr MotionKernels motion_kernels_with{
    stick_start_kernel<V, Varies>,      stick_step_kernel<V, false, Varies>,
    stick_step_kernel<E, true, Varies>, slide_kernel<V, true, Varies>,
    slide_kernel<V, false, Varies>,     bristle_kernel<V, true, Varies>,
    bristle_kernel<V, false, Varies>,   free_kernel<V, Varies>};

/// All kernels. @tparam V their vectors. @tparam E those of steps that locate events. @tparam P the vector of
/// those that go over all lanes.
template <class V, class E, class P>
inline constexpr Kernels kernels_with{lanes_at_stop_kernel<P>,
                                      fast_lanes_kernel<P>,
                                      sample_kernel<V, Decider::pid>,
                                      sample_kernel<V, Decider::blocks>,
                                      sample_kernel<V, Decider::lane_loop>,
                                      motion_kernels_with<V, E, false>,
                                      motion_kernels_with<V, E, true>,
                                      course_kernel<V>,
                                      bristle_rest_kernel<P>};

}  // namespace zerocount::batch

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

template <class V, class E, class P, bool Varies>
inline constexpr MotionKernels motion_kernels_with{stick_start_kernel<V, Varies, false>,
                                                   stick_step_kernel<V, false, Varies, false>,
                                                   stick_step_kernel<E, true, Varies, false>,
                                                   slide_kernel<V, true, Varies, false>,
                                                   slide_kernel<V, false, Varies, false>,
                                                   Varies ? nullptr : bristle_rest_kernel<P, false>,
                                                   bristle_kernel<V, true, Varies, false>,
                                                   bristle_kernel<V, false, Varies, false>,
                                                   free_kernel<V, Varies>};

/// The same of lanes with a second mass. The torque of its coupling has no bound ahead, so that none of them
/// counts as fast.
template <class V, class E, class P, bool Varies>
inline constexpr MotionKernels loaded_kernels_with{stick_start_kernel<V, Varies, true>,
                                                   stick_step_kernel<V, false, Varies, true>,
                                                   stick_step_kernel<E, true, Varies, true>,
                                                   slide_kernel<V, false, Varies, true>,
                                                   slide_kernel<V, false, Varies, true>,
                                                   Varies ? nullptr : bristle_rest_kernel<P, true>,
                                                   bristle_kernel<V, false, Varies, true>,
                                                   bristle_kernel<V, false, Varies, true>,
                                                   loaded_free_kernel<V, Varies>};

/// All kernels. @tparam V their vectors. @tparam E those of steps that locate events. @tparam P the vector of
/// those that go over all lanes.
template <class V, class E, class P>
inline constexpr Kernels kernels_with{lanes_at_stop_kernel<P>,
                                      fast_lanes_kernel<P>,
                                      sample_kernel<V, Decider::pid>,
                                      sample_kernel<V, Decider::blocks>,
                                      sample_kernel<V, Decider::lane_loop>,
                                      motion_kernels_with<V, E, P, false>,
                                      motion_kernels_with<V, E, P, true>,
                                      loaded_kernels_with<V, E, P, false>,
                                      loaded_kernels_with<V, E, P, true>,
                                      course_kernel<V>};

}  // namespace zerocount::batch

#pragma once

#include "core/batch/kernels/applied_torque.hpp"
#include "core/batch/kernels/bristle_kernel.hpp"
#include "core/batch/kernels/creep_ahead_kernel.hpp"
#include "core/batch/kernels/drive_kernel.hpp"
#include "core/batch/kernels/elements_kernel.hpp"
#include "core/batch/kernels/free_kernel.hpp"
#include "core/batch/kernels/kernels.hpp"
#include "core/batch/kernels/lane_sets_kernel.hpp"
#include "core/batch/kernels/noisy_rest_kernel.hpp"
#include "core/batch/kernels/sample_kernel.hpp"
#include "core/batch/kernels/slide_kernel.hpp"
#include "core/batch/kernels/stand_kernel.hpp"
#include "core/batch/kernels/stick_start_kernel.hpp"
#include "core/batch/kernels/stick_step_kernel.hpp"

namespace zerocount::batch {

template <class V, class E, class P, bool Varies>
inline constexpr MotionKernels motion_kernels_with{
    .stick_start = Varies ? nullptr : stick_start_kernel<V, false, false>,
    .stick_start_varying = Varies ? stick_start_kernel<V, true, false> : nullptr,
    .stick_step = stick_step_kernel<V, false, Varies, false>,
    .stick_event = stick_step_kernel<E, true, Varies, false>,
    .slide_fast = slide_kernel<V, true, Varies, false>,
    .slide_slow = slide_kernel<V, false, Varies, false>,
    .bristle_rest = Varies ? nullptr : bristle_rest_kernel<P, false>,
    .bristle_fast = bristle_kernel<V, true, Varies, false>,
    .bristle_slow = bristle_kernel<V, false, Varies, false>,
    .elements_rest = Varies ? nullptr : elements_rest_kernel<P, false>,
    .elements = elements_kernel<V, Varies, false>,
    .free = free_kernel<V, Varies>,
    .stand = Varies ? stand_coupled_kernel<V, true, false> : stand_kernel<V>};

/// The same of lanes with a second mass, whose torque may vary with `Driven`.
template <class V, class E, class P, bool Driven>
inline constexpr MotionKernels loaded_kernels_with{
    .stick_start = stick_start_kernel<V, false, true>,
    .stick_start_varying = Driven ? stick_start_kernel<V, true, true> : nullptr,
    .stick_step = stick_step_kernel<V, false, Driven, true>,
    .stick_event = stick_step_kernel<E, true, Driven, true>,
    .slide_fast = slide_kernel<V, true, Driven, true>,
    .slide_slow = slide_kernel<V, false, Driven, true>,
    .bristle_rest = bristle_rest_kernel<P, true>,
    .bristle_fast = bristle_kernel<V, true, Driven, true>,
    .bristle_slow = bristle_kernel<V, false, Driven, true>,
    .elements_rest = elements_rest_kernel<P, true>,
    .elements = elements_kernel<V, Driven, true>,
    .free = loaded_free_kernel<V, Driven>,
    .stand = stand_coupled_kernel<V, Driven, true>};

/// All kernels. @tparam V their vectors. @tparam E those of steps that locate events. @tparam P the vector of
/// those that go over all lanes.
template <class V, class E, class P>
inline constexpr Kernels kernels_with{lanes_at_stop_kernel<P>,
                                      fast_lanes_kernel<P>,
                                      creep_ahead_kernel<V>,
                                      noisy_rest_kernel<V>,
                                      sample_kernel<V, Decider::pid, false>,
                                      sample_kernel<V, Decider::blocks, false>,
                                      sample_kernel<V, Decider::pid, true>,
                                      sample_kernel<V, Decider::blocks, true>,
                                      sample_kernel<V, Decider::lane_loop, false>,
                                      motion_kernels_with<V, E, P, false>,
                                      motion_kernels_with<V, E, P, true>,
                                      loaded_kernels_with<V, E, P, false>,
                                      loaded_kernels_with<V, E, P, true>,
                                      drive_kernel<V>,
                                      course_kernel<V>};

}  // namespace zerocount::batch

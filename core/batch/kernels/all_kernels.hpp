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

/// All inner loops of the batch engine, for one instruction set.
/// @tparam Width number of doubles in a vector.
/// @tparam EventChains number of vectors that are processed side by side in integration steps that locate
/// events.
template <int Width, int EventChains>
inline constexpr Kernels kernels_with{
    .lanes_at_stop = lanes_at_stop_kernel<Simd<Width, 1>>,
    .fast_lanes = fast_lanes_kernel<Simd<Width, 1>>,
    .creep_ahead = creep_ahead_kernel<Vectors<Width, 2>>,
    .noisy_rest = noisy_rest_kernel<Vectors<Width, 2>>,
    .sample = sample_kernel<Vectors<Width, 2>, Decider::pid, false>,
    .sample_blocks = sample_kernel<Vectors<Width, 2>, Decider::blocks, false>,
    .sample_noisy = sample_kernel<Vectors<Width, 2>, Decider::pid, true>,
    .sample_noisy_blocks = sample_kernel<Vectors<Width, 2>, Decider::blocks, true>,
    .sample_given = sample_kernel<Vectors<Width, 2>, Decider::lane_loop, false>,
    .stick_start = stick_start_kernel<Vectors<Width, 2>>,
    .stick_step = stick_step_kernel<Vectors<Width, 2>, false>,
    .stick_event = stick_step_kernel<Simd<Width, EventChains>, true>,
    .slide_fast = slide_kernel<Vectors<Width, 2>, true>,
    .slide_slow = slide_kernel<Vectors<Width, 2>, false>,
    .bristle_rest = bristle_rest_kernel<Simd<Width, 1>>,
    .bristle_fast = bristle_kernel<Vectors<Width, 2>, true>,
    .bristle_slow = bristle_kernel<Vectors<Width, 2>, false>,
    .elements_rest = elements_rest_kernel<Simd<Width, 1>>,
    .elements = elements_kernel<Vectors<Width, 2>>,
    .free = free_kernel<Vectors<Width, 2>>,
    .free_loaded = loaded_free_kernel<Vectors<Width, 2>>,
    .stand = stand_kernel<Vectors<Width, 2>>,
    .stand_forced = stand_forced_kernel<Vectors<Width, 2>>,
    .drive = drive_kernel<Vectors<Width, 2>>,
    .course = course_kernel<Vectors<Width, 2>>};

}  // namespace zerocount::batch

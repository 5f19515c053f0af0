#include "core/batch/bristle_kernel.hpp"
#include "core/batch/free_kernel.hpp"
#include "core/batch/kernels.hpp"
#include "core/batch/lanes_at_stop_kernel.hpp"
#include "core/batch/sample_kernel.hpp"
#include "core/batch/slide_kernel.hpp"
#include "core/batch/stick_start_kernel.hpp"
#include "core/batch/stick_step_kernel.hpp"

namespace zerocount::batch {

using Portable = Vectors<2, 2>;

const Kernels portable_kernels{lanes_at_stop_kernel<Simd<2, 1>>,
                               sample_kernel<Portable, Decider::pid>,
                               sample_kernel<Portable, Decider::blocks>,
                               sample_kernel<Portable, Decider::lane_loop>,
                               stick_start_kernel<Portable>,
                               stick_step_kernel<Portable, false>,
                               stick_step_kernel<Vectors<2, 1>, true>,
                               slide_kernel<Portable, true>,
                               slide_kernel<Portable, false>,
                               bristle_rest_kernel<Simd<2, 1>>,
                               bristle_kernel<Portable, true>,
                               bristle_kernel<Portable, false>,
                               free_kernel<Portable>};

}  // namespace zerocount::batch

#include "core/batch/bristle_kernel.hpp"
#include "core/batch/free_kernel.hpp"
#include "core/batch/kernels.hpp"
#include "core/batch/lanes_at_stop_kernel.hpp"
#include "core/batch/sample_kernel.hpp"
#include "core/batch/slide_kernel.hpp"
#include "core/batch/stick_start_kernel.hpp"
#include "core/batch/stick_step_kernel.hpp"

namespace zerocount::batch {

using Avx2 = Vectors<4, 2>;

const Kernels avx2_kernels{lanes_at_stop_kernel<Simd<4, 1>>,
                           sample_kernel<Avx2, Decider::pid>,
                           sample_kernel<Avx2, Decider::blocks>,
                           sample_kernel<Avx2, Decider::lane_loop>,
                           stick_start_kernel<Avx2>,
                           stick_step_kernel<Avx2, false>,
                           stick_step_kernel<Vectors<4, 1>, true>,
                           slide_kernel<Avx2, true>,
                           slide_kernel<Avx2, false>,
                           bristle_rest_kernel<Simd<4, 1>>,
                           bristle_kernel<Avx2, true>,
                           bristle_kernel<Avx2, false>,
                           free_kernel<Avx2>};

}  // namespace zerocount::batch

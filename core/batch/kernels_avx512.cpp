#include "core/batch/bristle_kernel.hpp"
#include "core/batch/free_kernel.hpp"
#include "core/batch/kernels.hpp"
#include "core/batch/lanes_at_stop_kernel.hpp"
#include "core/batch/sample_kernel.hpp"
#include "core/batch/slide_kernel.hpp"
#include "core/batch/stick_start_kernel.hpp"
#include "core/batch/stick_step_kernel.hpp"

namespace zerocount::batch {

using Avx512 = Vectors<8, 2>;

const Kernels avx512_kernels{lanes_at_stop_kernel<Simd<8, 1>>,
                             sample_kernel<Avx512, Decider::pid>,
                             sample_kernel<Avx512, Decider::blocks>,
                             sample_kernel<Avx512, Decider::lane_loop>,
                             stick_start_kernel<Avx512>,
                             stick_step_kernel<Avx512, false>,
                             stick_step_kernel<Avx512, true>,
                             slide_kernel<Avx512, true>,
                             slide_kernel<Avx512, false>,
                             bristle_rest_kernel<Simd<8, 1>>,
                             bristle_kernel<Avx512, true>,
                             bristle_kernel<Avx512, false>,
                             free_kernel<Avx512>};

}  // namespace zerocount::batch

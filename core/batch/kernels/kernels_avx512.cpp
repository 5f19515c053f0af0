#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels avx512_kernels = kernels_with<Vectors<8, 2>, Vectors<8, 2>, Simd<8, 1>>;

}  // namespace zerocount::batch

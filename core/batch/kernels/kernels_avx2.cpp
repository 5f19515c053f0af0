#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels avx2_kernels = kernels_with<Vectors<4, 2>, Vectors<4, 1>, Simd<4, 1>>;

}  // namespace zerocount::batch

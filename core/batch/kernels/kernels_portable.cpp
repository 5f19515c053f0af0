#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels portable_kernels = kernels_with<Vectors<2, 2>, Vectors<2, 1>, Simd<2, 1>>;

}  // namespace zerocount::batch

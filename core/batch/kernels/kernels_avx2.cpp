#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels avx2_kernels = kernels_with<4, 1>;

}  // namespace zerocount::batch

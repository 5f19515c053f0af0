#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels avx512_kernels = kernels_with<8, 2>;

}  // namespace zerocount::batch

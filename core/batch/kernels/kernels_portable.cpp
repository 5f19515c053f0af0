#include "core/batch/kernels/all_kernels.hpp"

namespace zerocount::batch {

const Kernels portable_kernels = kernels_with<2, 1>;

}  // namespace zerocount::batch

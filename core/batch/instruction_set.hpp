#pragma once

#include <string_view>

#include "core/batch/kernels.hpp"

namespace zerocount::batch {

/// What the kernels of the batch engine may be made of. The results are the same with each.
enum class InstructionSet { portable, avx2, avx512 };

/// Whether this processor has it, and the kernels were built for it.
bool is_available(InstructionSet instructions);

/// The widest that is available.
InstructionSet widest_instruction_set();

std::string_view name_of(InstructionSet instructions);

const Kernels& kernels_of(InstructionSet instructions);

}  // namespace zerocount::batch

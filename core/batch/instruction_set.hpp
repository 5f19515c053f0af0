#pragma once

#include <string_view>

#include "core/batch/kernels.hpp"

namespace zerocount::batch {

/// Instruction sets of the kernels of the batch engine. All give the same results.
enum class InstructionSet { portable, avx2, avx512 };

/// Whether this processor has the instruction set and the kernels were built for it.
bool is_available(InstructionSet instructions);

/// The widest available instruction set.
InstructionSet widest_instruction_set();

std::string_view name_of(InstructionSet instructions);

const Kernels& kernels_of(InstructionSet instructions);

}  // namespace zerocount::batch

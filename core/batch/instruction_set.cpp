#include <algorithm>
#include <array>

#include "core/batch/batch.hpp"
#include "core/batch/kernels/kernels.hpp"

namespace zerocount::batch {
namespace {

struct BuiltKernels {
  InstructionSet instructions;
  const Kernels* kernels;
};

/// Kernels (inner loops) that this build contains, one entry per instruction set, the widest first.
constexpr std::array built{
#ifdef ZEROCOUNT_KERNELS_AVX512
    BuiltKernels{InstructionSet::avx512, &avx512_kernels},
#endif
#ifdef ZEROCOUNT_KERNELS_AVX2
    BuiltKernels{InstructionSet::avx2, &avx2_kernels},
#endif
#ifdef ZEROCOUNT_KERNELS_PORTABLE
    BuiltKernels{InstructionSet::portable, &portable_kernels},
#endif
};

bool processor_has(InstructionSet instructions) {
  switch (instructions) {
    case InstructionSet::portable:
      return true;
#ifdef __x86_64__
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512bw") != 0;
#else
    case InstructionSet::avx2:
    case InstructionSet::avx512:
      return false;
#endif
  }
  return false;
}

}  // namespace

bool is_available(InstructionSet instructions) {
  return processor_has(instructions) &&
         std::ranges::find(built, instructions, &BuiltKernels::instructions) != built.end();
}

InstructionSet widest_instruction_set() {
  for (const BuiltKernels& one : built) {
    if (processor_has(one.instructions)) return one.instructions;
  }
  return built.back().instructions;
}

std::string_view name_of(InstructionSet instructions) {
  switch (instructions) {
    case InstructionSet::avx512:
      return "AVX-512";
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::portable:
      break;
  }
  return "portable";
}

const Kernels& kernels_of(InstructionSet instructions) {
  const auto* const found = std::ranges::find(built, instructions, &BuiltKernels::instructions);
  return *(found == built.end() ? built.back() : *found).kernels;
}

}  // namespace zerocount::batch

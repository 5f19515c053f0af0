#include "core/batch/batch.hpp"
#include "core/batch/kernels/kernels.hpp"

namespace zerocount::batch {

bool is_available(InstructionSet instructions) {
  switch (instructions) {
    case InstructionSet::portable:
      return true;
#ifdef ZEROCOUNT_X86_KERNELS
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

InstructionSet widest_instruction_set() {
  for (const InstructionSet wide : {InstructionSet::avx512, InstructionSet::avx2}) {
    if (is_available(wide)) return wide;
  }
  return InstructionSet::portable;
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

const Kernels& kernels_of([[maybe_unused]] InstructionSet instructions) {
#ifdef ZEROCOUNT_X86_KERNELS
  if (instructions == InstructionSet::avx512) return avx512_kernels;
  if (instructions == InstructionSet::avx2) return avx2_kernels;
#endif
  return portable_kernels;
}

}  // namespace zerocount::batch

#include "core/batch/instruction_set.hpp"

#include <set>

#include <gtest/gtest.h>

#include "tests/core/batch/batched_trials.hpp"

namespace zerocount::testing {
namespace {

TEST(InstructionSets, PortableIsAlwaysThereAndTheWidestIsOneOfThem) {
  const std::vector<InstructionSet> sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::portable);
  EXPECT_EQ(sets.back(), widest_instruction_set());
  EXPECT_EQ(BatchSettings{}.instructions, widest_instruction_set());
}

TEST(InstructionSets, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const InstructionSet set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512}) {
    names.insert(name_of(set));
  }
  EXPECT_EQ(names.size(), 3U);
}

}  // namespace
}  // namespace zerocount::testing

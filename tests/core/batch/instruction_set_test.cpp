#include "core/batch/batch.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

TEST(InstructionSets, PortableIsAlwaysThereAndTheWidestIsOneOfThem) {
  const std::vector<batch::InstructionSet> sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), batch::InstructionSet::portable);
  EXPECT_EQ(sets.back(), batch::widest_instruction_set());
  EXPECT_EQ(batch::BatchSettings{}.instructions, batch::widest_instruction_set());
}

TEST(InstructionSets, HaveDifferentNames) {
  std::set<std::string_view> names;
  for (const batch::InstructionSet set :
       {batch::InstructionSet::portable, batch::InstructionSet::avx2, batch::InstructionSet::avx512}) {
    names.insert(batch::name_of(set));
  }
  EXPECT_EQ(names.size(), 3U);
}

}  // namespace
}  // namespace zerocount::testing

#include "core/text/counted.hpp"

#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

TEST(Counted, OneIsSingular) {
  EXPECT_EQ(text::counted(std::int64_t{1}, "move"), "1 move");
  EXPECT_EQ(text::counted(std::size_t{0}, "move"), "0 moves");
  EXPECT_EQ(text::counted(11, "design point"), "11 design points");
}

}  // namespace
}  // namespace zerocount::testing

// The compiler counts the members of structures like those that the lanes are made for.
#include "core/batch/lanes/member_count.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::batch {
namespace {

struct Part {
  double value{1.0};
  std::array<int, 3> numbers{};
};
struct Whole {
  Part part{};
  double number{0.0};
  std::vector<Part> parts{};
  std::shared_ptr<const Part> shared{};
  std::string name{};
  enum class Kind { one } kind{Kind::one};
};
struct Extended {
  Whole whole;
  bool flag{false};
};
struct Empty {};

TEST(MemberCount, CountsEachMemberOnceWhateverItsType) {
  EXPECT_EQ(member_count<Empty>(), 0U);
  EXPECT_EQ(member_count<Part>(), 2U);
  EXPECT_EQ(member_count<Whole>(), 6U);
  EXPECT_EQ(member_count<Extended>(), 2U);
}

}  // namespace
}  // namespace zerocount::batch

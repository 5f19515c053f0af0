#include <string>

#include <gtest/gtest.h>

#include "results/layout/header.hpp"

namespace zerocount::layout {
namespace {

bool matches(const std::string& text, const std::string& expression) {
  return ::testing::Matcher<std::string>(::testing::MatchesRegex(expression)).Matches(text);
}

TEST(Provenance, NamesVersionCommitCompilerProcessorAndTime) {
  const Provenance provenance = current_provenance();
  EXPECT_TRUE(matches(provenance.zerocount_version, "[0-9]+[.][0-9]+[.][0-9]+"))
      << provenance.zerocount_version;
  EXPECT_TRUE(matches(provenance.git_commit, "unknown|[0-9a-f]{40}(-dirty)?")) << provenance.git_commit;
  EXPECT_TRUE(matches(provenance.compiler, "[A-Za-z]+ [0-9.]+")) << provenance.compiler;
  EXPECT_FALSE(provenance.cpu.empty());
  EXPECT_TRUE(matches(provenance.created, "[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"))
      << provenance.created;
}

TEST(Provenance, IsOfTheSameBuildByVersionAndCommit) {
  const auto build = [](const char* version, const char* commit) {
    return Provenance{version, commit, "GNU 12.2.0", "some processor", "2002-07-21T12:00:00Z"};
  };
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "a1b2")));
  EXPECT_TRUE(same_build(build("0.1.0", "unknown"), build("0.1.0", "unknown")));
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2-dirty"), build("0.1.0", "a1b2")));
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "a1b2-dirty")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "c3d4")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2-dirty"), build("0.1.0", "c3d4-dirty")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "unknown")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.2.0", "a1b2")));
  EXPECT_TRUE(is_dirty(build("0.1.0", "a1b2-dirty")));
  EXPECT_FALSE(is_dirty(build("0.1.0", "a1b2")));
}

}  // namespace
}  // namespace zerocount::layout

#include "results/layout/build_info.hpp"

#include <string>

#include <gtest/gtest.h>

namespace zerocount {
namespace {

bool matches(const std::string& text, const std::string& expression) {
  return testing::Matcher<std::string>(testing::MatchesRegex(expression)).Matches(text);
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

}  // namespace
}  // namespace zerocount

// Every output of a study speaks of the same design point.
#include <regex>

#include <nlohmann/json.hpp>

#include "tests/runners/program.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// A small study with a sweep, rigs or not, a goal or not.
std::string random_manifest(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const auto within = [&](double low, double high) { return low + (high - low) * uniform(random); };
  std::string manifest = fmt::format("zerocount: 1\nname: drawn\nseed: {}\ntrials: 40\n", random() % 100000);
  if (uniform(random) < 0.5) manifest += "rigs: 10\n";
  manifest +=
      fmt::format("friction: {{k1: {{uniform: [{:.3g}, {:.3g}]}}}}\n", within(60, 90), within(100, 140));
  manifest +=
      "command: {targets: [{integers: [-20, 20]}], hold: 0.2}\nverdict: {dwell: 0.02, window: 0.02}\n";
  manifest += "initial: {encoder_phase: {uniform: [0, 1]}}\n";
  if (uniform(random) < 0.5) {
    manifest += fmt::format("goal: {{band: {}, within: {:.3g}, moves: {:.2g}}}\n", random() % 3,
                            within(0.02, 0.1), within(0.3, 0.95));
  }
  return manifest + fmt::format(
                        "sweep: {{grid: {{controller.ki: {{logspace: [{:.3g}, {:.3g}, 4]}}, "
                        "controller.kp: [0, {:.3g}]}}}}\n",
                        within(1e-5, 5e-5), within(1e-4, 4e-4), within(1e-4, 1e-3));
}

TEST(OnePoint, IsTheSameInEveryOutputOfRandomStudies) {
  const TemporaryFolder folder;
  std::mt19937_64 random(1130);
  const auto run = [&](const std::vector<std::string>& words) {
    return zerocount_program(words, folder.path());
  };
  int with_goal = 0;
  for (int round = 0; round < 5; ++round) {
    const std::string manifest = random_manifest(random);
    SCOPED_TRACE(manifest);
    folder.write("study.yaml", manifest);
    ASSERT_EQ(run({"run", "study.yaml", "-q", "--force", "-o", "study.h5"}).code, 0);
    const auto summary = nlohmann::json::parse(run({"summary", "study.h5", "--format", "json"}).out);
    const auto best = summary["best"]["point"].get<std::int64_t>();

    const std::string table = run({"summary", "study.h5"}).out;
    EXPECT_TRUE(says(table, fmt::format("\n{} *", best), fmt::format("best of 8 points: {} (", best)));
    if (manifest.find("goal:") != std::string::npos) {
      ++with_goal;
      const ProgramResult judged = run({"judge", "study.h5", "--format", "json"});
      EXPECT_EQ(nlohmann::json::parse(judged.out)["point"], best);
    }
    EXPECT_TRUE(
        says(run({"summary", "study.h5", "--confirm", "20"}).err, fmt::format("the point {} (", best)));
    const std::string first_row = run({"summary", "study.h5", "--top", "1", "--format", "csv"}).out;
    EXPECT_TRUE(says(first_row, fmt::format("\n{},", best)));

    ASSERT_EQ(run({"report", "study.h5", "--force", "-o", "study.html"}).code, 0);
    const std::string page = folder.read("study.html");
    std::smatch named, star, trace;
    ASSERT_TRUE(std::regex_search(page, named, std::regex("Best of 8 points, ([0-9]*) \\(([^)]*)\\)")));
    ASSERT_TRUE(std::regex_search(page, star, std::regex("<td[^>]*>([^<]*) \\*<")));
    ASSERT_TRUE(std::regex_search(page, trace, std::regex("of point ([^,]*), simulated again")));
    EXPECT_EQ(named[1], std::to_string(best));
    EXPECT_EQ(star[1], std::to_string(best));
    EXPECT_EQ(trace[1], named[2]);
  }
  EXPECT_GE(with_goal, 1);
  EXPECT_LT(with_goal, 5);
}

}  // namespace
}  // namespace zerocount::testing

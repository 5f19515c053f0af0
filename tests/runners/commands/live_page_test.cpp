// `--watch`: the page while the work is done, at its end, and where it ends too early.
#include <csignal>

#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

constexpr const char* reload = "http-equiv=\"refresh\"";

constexpr const char* tunable = R"(zerocount: 1
name: tuned
seed: 7
trials: 100
machines: 50
command: {targets: [29], hold: 0.2}
friction: {k1: {lognormal: {median: 130, cv: 0.2}, per: machine}}
goal: {band: 1, within: 0.1, moves: 0.9}
tune: {free: {controller.ki: {log: [5.0e-6, 1.0e-3]}, controller.kp: [0, 5.0e-3]}}
)";

/// Whether the page contains the words. Unlike a test macro it does not print the page, which is too long.
bool has(const std::string& page, const std::string& words) {
  return page.find(words) != std::string::npos;
}

class LivePage : public ProgramTest {
 protected:
  void run(const std::vector<std::string>& words, int code = 0) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, code) << result.err;
  }

  /// Waits until the page has these words, and returns it. Whenever the page is read, it must be complete.
  std::string page_with(const std::string& words) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) {
      std::string page = folder_.read("watched.html");
      if (!page.empty()) {
        EXPECT_TRUE(page.ends_with("</html>\n"));
      }
      if (has(page, words)) return page;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << "no page with " << words;
    return "";
  }

  /// Runs a command and interrupts it when its live page contains `so_far`. Then starts the same command
  /// again and interrupts it when its page is live again.
  /// @returns the page after the first interruption
  std::string interrupted(const std::vector<std::string>& words, const std::string& so_far) {
    RunningProgram first(words, folder_.path());
    EXPECT_TRUE(has(page_with(so_far), reload));
    first.send(SIGINT);
    EXPECT_EQ(first.wait(), 130);
    std::string page = folder_.read("watched.html");
    RunningProgram second(words, folder_.path());
    page_with(reload);
    second.send(SIGINT);
    EXPECT_EQ(second.wait(), 130);
    return page;
  }
};

TEST_F(LivePage, BecomesTheReportAtTheEnd) {
  folder_.write("a.yaml", small_manifest(30));
  run({"run", "a.yaml", "-o", "a.h5", "--watch", "watched.html"});
  run({"report", "a.h5", "-o", "report.html"});
  const std::string page = folder_.read("watched.html");
  EXPECT_EQ(page, folder_.read("report.html"));
  EXPECT_FALSE(has(page, reload));
  run({"run", "a.yaml", "-o", "plain.h5"});
  expect_same_datasets(folder_ / "a.h5", folder_ / "plain.h5");
  run({"run", "a.yaml", "-o", "a.h5", "--watch", "again.html"});
  EXPECT_EQ(folder_.read("again.html"), page) << "of a file that is complete";

  folder_.write("sums.yaml", small_manifest(30, "keep: statistics\n"));
  run({"run", "sums.yaml", "-o", "sums.h5", "--watch", "sums.html"});
  EXPECT_EQ(folder_.read("sums.html"), program({"summary", "sums.h5", "--format", "html"}).out);
}

TEST_F(LivePage, ReportsAnInterruptedRun) {
  folder_.write("a.yaml", small_manifest(1'000'000, "goal: {band: 1, within: 0.1, moves: 0.9}\n"));
  const std::string page = interrupted(
      {"run", "a.yaml", "-o", "a.h5", "--engine", "reference", "--watch", "watched.html"}, "goal: ");
  EXPECT_TRUE(has(page, "give the same command again to continue"));
  EXPECT_TRUE(has(page, "unfinished: of the "));
  EXPECT_FALSE(has(page, reload));
}

TEST_F(LivePage, ReportsAnInterruptedTuning) {
  folder_.write("a.yaml", tunable);
  const std::string page = interrupted(
      {"tune", "a.yaml", "-o", "a.h5", "--budget", "60s", "--watch", "watched.html"}, "best so far: ");
  EXPECT_TRUE(has(page, "interrupted: the simulated points are kept in"));
  EXPECT_TRUE(has(page, " of 60 s"));
  EXPECT_TRUE(has(page, "best so far: controller.ki = "));
  EXPECT_FALSE(has(page, reload));
}

TEST_F(LivePage, BecomesTheReportOfATuningAtTheEnd) {
  folder_.write("a.yaml", tunable);
  run({"tune", "a.yaml", "-o", "a.h5", "--budget", "10000", "--report", "report.html", "--watch",
       "watched.html"});
  const std::string page = folder_.read("watched.html");
  EXPECT_EQ(page, folder_.read("report.html"));
  for (const char* const part :
       {"id=\"tuning\"", "id=\"tuning-limits\"", "figure-tuning-room", "id=\"overview\""})
    EXPECT_TRUE(has(page, part));
  EXPECT_FALSE(has(page, reload));
}

TEST_F(LivePage, ReportsTheErrorThatEndedTheRun) {
  folder_.write("a.yaml", small_manifest(30));
  run({"run", "a.yaml", "-o", "a.h5"});
  const ProgramResult result =
      program({"run", "a.yaml", "-o", "a.h5", "--set", "seed=99", "--watch", "watched.html"});
  EXPECT_EQ(result.code, 2);
  const std::string page = folder_.read("watched.html");
  EXPECT_TRUE(has(page, result.err.substr(0, 30)));
  EXPECT_FALSE(has(page, reload));
}

TEST_F(LivePage, AnUnwritablePathIsRefusedBeforeTheRun) {
  folder_.write("a.yaml", std::string(tunable));
  folder_.write("there.html", "somebody's");
  for (const char* const command : {"run", "tune"}) {
    const auto code = [&](const std::vector<std::string>& more) {
      std::vector<std::string> words{command, "a.yaml", "-o", "a.h5"};
      words.insert(words.end(), more.begin(), more.end());
      return program(words).code;
    };
    for (const char* const page : {"page.txt", "-", ".", "there.html", "a.yaml"})
      EXPECT_EQ(code({"--watch", page}), 2) << command << page;
    EXPECT_EQ(code({"--watch", "none/page.html"}), 5) << command;
  }
  EXPECT_EQ(program({"run", "a.yaml", "-o", "one.html", "--watch", "one.html"}).code, 2);
  EXPECT_EQ(program({"run", "a.yaml", "-o", "a.h5", "--shard", "1/2", "--watch", "page.html"}).code, 2);
  EXPECT_EQ(program({"tune", "a.yaml", "-o", "a.h5", "--report", "p.html", "--watch", "p.html"}).code, 2);
  EXPECT_EQ(folder_.read("there.html"), "somebody's");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.h5.shards"));
}

}  // namespace
}  // namespace zerocount::testing

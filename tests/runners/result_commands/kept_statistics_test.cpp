// Studies that keep statistics, or the trials that failed, in place of all trials.
#include <csignal>

#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

class KeptStatistics : public ProgramTest {
 protected:
  fs::path at(const std::string& name) const { return folder_.path() / name; }
  ProgramResult run(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "study.yaml", "-q", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result;
  }
  std::string text_of(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(at(name)).rdbuf();
    return text.str();
  }
  std::string summary(const std::string& file, const std::string& format = "json") const {
    const ProgramResult result = program({"summary", file, "--format", format, "--confidence", "0.9"});
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  }
  void export_tables(const std::string& file, const std::string& folder) const {
    const ProgramResult result = program({"export", file, "-o", folder});
    ASSERT_EQ(result.code, 0) << result.err;
  }
};

struct StudyText {
  const char* name;
  std::string text;
};
void PrintTo(const StudyText& study, std::ostream* out) {
  *out << study.name;
}

class StatisticsWithoutTrials : public KeptStatistics, public ::testing::WithParamInterface<StudyText> {};

TEST_P(StatisticsWithoutTrials, EqualThoseOfARunThatKeepsItsTrials) {
  folder_.write("study.yaml", GetParam().text);
  run("full.h5");
  run("kept.h5", {"--set", "keep=statistics"});
  EXPECT_TRUE(summary("kept.h5") == summary("full.h5"));
  EXPECT_TRUE(summary("kept.h5", "table") == summary("full.h5", "table"));
  export_tables("full.h5", "full");
  export_tables("kept.h5", "kept");
  for (const char* table : {"points.csv", "profiles.csv", "machines.csv", "machine_counts.csv", "levels.csv"})
    EXPECT_TRUE(text_of(std::string("kept/") + table) == text_of(std::string("full/") + table)) << table;
  EXPECT_FALSE(fs::exists(at("kept/trials.csv")));
}

TEST_P(StatisticsWithoutTrials, DoNotDependOnTheDivisionOfTheTrials) {
  const bool open_loop = GetParam().text.find("torque") != std::string::npos;
  folder_.write("study.yaml", GetParam().text + (open_loop ? "keep: statistics\n" : "keep: failures\n"));
  run("whole.h5", {"--threads", "1"});
  for (const char* part : {"1", "2", "3"})
    run(std::string("part") + part + ".h5", {"--threads", "4", "--shard", std::string(part) + "/3"});
  EXPECT_EQ(program({"merge", "part3.h5", "part1.h5", "part2.h5", "-o", "merged.h5"}).code, 0);
  expect_same_datasets(at("merged.h5"), at("whole.h5"));
}

// The second of three parts is missing; some points may have no trial, and some only a part of theirs.
TEST_P(StatisticsWithoutTrials, FromAnUnfinishedRunEqualThoseOfARunThatKeepsItsTrials) {
  folder_.write("study.yaml", GetParam().text);
  for (const char* keep : {"trials", "statistics"}) {
    const std::string name = keep;
    fs::create_directory(at(name + ".h5.parts"));
    for (const char* part : {"1", "3"})
      run(name + ".h5.parts/part-" + part + "-of-3.h5", {"--set", "keep=" + name, "--shard", part + "/3"s});
  }
  EXPECT_TRUE(summary("statistics.h5") == summary("trials.h5"));
  EXPECT_TRUE(summary("statistics.h5", "table") == summary("trials.h5", "table"));
}

const std::string torques =
    "zerocount: 1\nname: torques\nseed: 3\ntrials: 90\nfriction: {k1: {uniform: [100, 160]}}\n"
    "command: {torque: {levels: [0.01, -0.01, 0.02]}, hold: 0.1}\n";

INSTANTIATE_TEST_SUITE_P(All, StatisticsWithoutTrials,
                         ::testing::Values(StudyText{"jerks",
                                                     small_manifest(90, "design: latin_hypercube\n")},
                                           StudyText{"machines", small_manifest(90, "machines: 30\n")},
                                           StudyText{"machines_in_open_loop", torques + "machines: 9\n"}),
                         [](const auto& tested) { return tested.param.name; });

TEST_F(KeptStatistics, AnInterruptedRunHasTheSameStatistics) {
  folder_.write("study.yaml", small_manifest(16000, "keep: statistics\n"));
  RunningProgram running({"run", "study.yaml", "-q", "-o", "out.h5", "--threads", "1"}, folder_.path());
  running.wait_for_shards(at("out.h5.shards"));
  const ProgramResult status = program({"status", "out.h5"});
  running.send(SIGINT);
  EXPECT_EQ(running.wait(), 130);
  EXPECT_TRUE(says(status.out, "unfinished"));
  run("out.h5");
  run("whole.h5");
  expect_same_datasets(at("out.h5"), at("whole.h5"));
  EXPECT_TRUE(says(program({"run", "study.yaml", "-o", "out.h5"}).err, "already complete"));
}

TEST_F(KeptStatistics, FileSizeDoesNotGrowWithTheTrials) {
  const auto bytes = [&](int trials) {
    folder_.write("study.yaml", small_manifest(trials, "keep: statistics\n"));
    run("out.h5", {"--force"});
    return static_cast<double>(fs::file_size(at("out.h5")));
  };
  const double few = bytes(2000);
  EXPECT_LT(bytes(10000), 1.3 * few);  // five times as many have some more distinct values
}

std::vector<std::string> lines_of(const std::string& table) {
  std::stringstream text(table);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST_F(KeptStatistics, KeptFailuresCanBeReplayed) {
  folder_.write("study.yaml", small_manifest(200));
  run("full.h5");
  run("kept.h5", {"--set", "keep=failures"});
  EXPECT_TRUE(summary("kept.h5") == summary("full.h5"));
  export_tables("full.h5", "full");
  export_tables("kept.h5", "kept");
  const std::vector<std::string> all = lines_of(text_of("full/outcomes.csv"));
  std::vector<std::string> failures{all.front()};
  for (std::size_t i = 1; i < all.size(); ++i)  // one move each
    if (all[i].find(",zero_count,") == std::string::npos) failures.push_back(all[i]);
  ASSERT_GT(failures.size(), 10U);
  ASSERT_LT(failures.size(), all.size());
  EXPECT_TRUE(lines_of(text_of("kept/outcomes.csv")) == failures);
  EXPECT_EQ(lines_of(text_of("kept/trials.csv")).size(), failures.size());
  const std::string row = failures.back().substr(0, failures.back().find(','));
  const std::string index = std::to_string(std::stoi(row) % 200);
  const auto trace = [&](const std::string& trial) {
    return program({"trace", "kept.h5", "--point", "1", "--trial", trial, "-o", "-"});
  };
  EXPECT_EQ(trace(index).code, 0) << trace(index).err;
  const ProgramResult verified = program({"verify", "kept.h5", "--trials", "400"});
  EXPECT_EQ(verified.code, 0) << verified.out;
  EXPECT_TRUE(says(verified.out, "400 of 400"));
  fs::copy_file(at("kept.h5"), at("success.h5"));
  change_element(at("success.h5"), "/outcome/outcome", 0);  // from another outcome to zero_count
  const ProgramResult success = program({"verify", "success.h5", "--trials", "1"});
  EXPECT_EQ(success.code, 4) << success.out;
  EXPECT_TRUE(says(success.out, "kept as a failure"));
  fs::copy_file(at("kept.h5"), at("jerks.h5"));
  change_element(at("jerks.h5"), "/jerk/move", 0);
  EXPECT_EQ(program({"verify", "jerks.h5", "--trials", "1"}).code, 4);
  set_element(at("kept.h5"), "/outcome/holding_torque", failures.size() - 2, 1.0);
  EXPECT_EQ(trace(index).code, 4);
  EXPECT_EQ(program({"verify", "kept.h5", "--trials", "400"}).code, 4);
}

TEST_F(KeptStatistics, CommandsThatNeedTrialsRefuseThem) {
  folder_.write("study.yaml", small_manifest(50, "keep: statistics\n"));
  run("out.h5");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"jerks", "out.h5"},
                                                {"report", "out.h5", "-o", "out.html"},
                                                {"sensitivity", "out.h5"},
                                                {"compare", "out.h5", "out.h5"}}) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 4) << words.front();
    EXPECT_TRUE(says(result.err, "keep: statistics"));
  }
  folder_.write("study.yaml", small_manifest(50, "keep: statistics\nretain: {trials: [0]}\n"));
  EXPECT_TRUE(says(refusal({"check", "study.yaml"}), "expected keep: trials"));
}

TEST_F(KeptStatistics, StatisticsAndTrialsAreNotMerged) {
  folder_.write("study.yaml", small_manifest(50));
  run("trials.h5", {"--shard", "1/2"});
  run("statistics.h5", {"--shard", "2/2", "--set", "keep=statistics"});
  for (const std::vector<std::string>& parts :
       {std::vector<std::string>{"trials.h5", "statistics.h5"}, {"statistics.h5", "trials.h5"}}) {
    EXPECT_TRUE(says(refusal({"merge", parts[0], parts[1], "-o", "out.h5"}, 4),
                     parts[1] + ": is from another study"));
  }
}

TEST_F(KeptStatistics, ImpossibleStatisticsAreRefused) {
  folder_.write("study.yaml", small_manifest(50, "keep: statistics\n"));
  run("out.h5");
  const std::size_t numbers = sizes_of_numbers(at("out.h5")).at("/sums/whole");
  int refused = 0;
  for (std::size_t i = 0; i < numbers; i += numbers / 16) {
    fs::copy_file(at("out.h5"), at("changed.h5"), fs::copy_options::overwrite_existing);
    change_element(at("changed.h5"), "/sums/whole", i);
    const ProgramResult result = program({"summary", "changed.h5"});
    EXPECT_TRUE(result.code == 0 || result.code == 4) << result.code << result.err;
    refused += result.code == 4;
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace zerocount::testing

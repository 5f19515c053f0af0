// `zerocount verify`: a file passes as it was written, and any change of it is found and named.

#include "experiments/manifest/load_study.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/verification/replay.hpp"
#include "runners/verification/verification.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;
using verification::CheckReport;

// Slides and re-sticks, machines with rotors, jerks, records of samples.
const char* const verified_manifest =
    "zerocount: 1\nname: verified\nseed: 5\ntrials: 16\nmachines: 4\n"
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.2}}, cv: 0.1, correlation_length: 0.3}}\n"
    "  k2: {uniform: [600, 900]}\n"
    "  lambda: 0.5\n"
    "command: {targets: [{integers: [1, 30]}, 0], hold: 0.15}\n"
    "initial: {encoder_phase: {uniform: [0, 1]}, position: {uniform: [0, 6.283185307179586]}}\n"
    "verdict: {dwell: 0.02, window: 0.02}\n"
    "sweep: {grid: {controller.ki: [3.85e-5, 2.08e-4]}}\n"
    "retain: {trials: [3]}\n";

/// The last part of the path of a dataset, by which messages name it too.
std::string base_name(const std::string& dataset) {
  return dataset.substr(dataset.rfind('/') + 1);
}

std::string problems_of(const std::vector<CheckReport>& reports) {
  std::string text;
  for (const CheckReport& report : reports) {
    for (const verification::Check& check : report.checks) {
      for (const std::string& problem : check.problems)
        text += report.path.filename().string() + ": " + check.name + ": " + problem + "\n";
    }
  }
  return text;
}

class Verify : public ProgramTest {
 protected:
  Verify() { folder_.write("study.yaml", verified_manifest); }

  void make(const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", "study.yaml", "-q", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    ASSERT_EQ(result.code, 0) << result.err;
  }

  /// Makes the shards that a run leaves if it is killed at its end: each has one of `pieces` equal parts of
  /// the trials.
  fs::path make_shards(const std::string& name, const std::string& manifest, std::int64_t pieces) {
    const study::Study study =
        manifest::load_study(folder_.write(name + ".yaml", manifest), {}, {.plugin = {}, .samples = {}});
    const fs::path shards = folder_ / (name + ".h5.shards");
    fs::create_directory(shards);
    const std::int64_t size = study::trial_count(study) / pieces;
    for (std::int64_t piece = 0; piece < pieces; ++piece) {
      const std::vector<layout::RowRange> rows{{piece * size, size}};
      trials::run_trials(study, rows, shards, {}, {});
    }
    return shards;
  }

  std::string problems(const std::string& name, std::int64_t trials = 1000) const {
    const std::vector<fs::path> operands{folder_ / name};
    return problems_of(verification::verify(operands, {.trials = trials}));
  }

  fs::path copy(const std::string& name) const {
    fs::copy_file(folder_ / "out.h5", folder_ / name, fs::copy_options::overwrite_existing);
    return folder_ / name;
  }
};

TEST_F(Verify, AcceptsAnUnchangedFile) {
  make("out.h5");
  EXPECT_EQ(problems("out.h5"), "");
  const ProgramResult result = program({"verify", "out.h5"});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  for (const char* check : {"checksum", "statistics", "trials run again"})
    EXPECT_TRUE(says(result.out, std::string("ok      out.h5: ") + check + ": ")) << check;
  EXPECT_FALSE(says(result.out, "FAILED"));
}

TEST_F(Verify, NamesTheDatasetOfAnyValueThatWasChanged) {
  make("out.h5");
  std::vector<std::pair<std::string, std::size_t>> datasets;
  for (const auto& [dataset, size] : sizes_of_numbers(folder_ / "out.h5")) {
    if (size > 0) datasets.emplace_back(dataset, size);
  }
  ASSERT_GT(datasets.size(), 60U);
  std::mt19937 random(7);
  for (int repetition = 0; repetition < 24; ++repetition) {
    const auto& [dataset, size] = datasets[random() % datasets.size()];
    change_element(copy("changed.h5"), dataset, random() % size);
    const std::string found = problems("changed.h5");
    const auto names = [&](const std::string& words) { return found.find(words) != std::string::npos; };
    // Some contradict another dataset, which is named in their place.
    EXPECT_TRUE(names(dataset) || names(base_name(dataset) + ": recorded ") ||
                names(base_name(dataset) + "[") || (dataset.starts_with("/jerk/") && names("/jerk/")) ||
                (dataset.ends_with("arrival_time") && names("/outcome/arrived")))
        << dataset << "\n"
        << found;
  }
}

TEST_F(Verify, FindsAChangedAttribute) {
  make("out.h5");
  replace_attribute(copy("seed.h5"), "name", std::string("other"));
  EXPECT_TRUE(
      says(problems("seed.h5"), "statistics: the attribute 'name' is other; its manifest says verified"));
  replace_attribute(copy("hash.h5"), "study_sha256", std::string("0"));
  EXPECT_TRUE(says(problems("hash.h5"), "statistics: the attribute 'study_sha256' is 0"));
  remove_attribute(copy("unfinished.h5"), "finished");
  EXPECT_TRUE(says(problems("unfinished.h5"), "statistics: it was never finished"));
}

TEST_F(Verify, FindsAFlippedByteAndACutFileByTheChecksum) {
  make("out.h5");
  const std::string bytes = read_bytes(folder_ / "out.h5");
  std::mt19937 random(11);
  for (int repetition = 0; repetition < 20; ++repetition) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] ^= 4;
    folder_.write("flipped.h5", damaged);
    EXPECT_NE(problems("flipped.h5"), "");
    folder_.write("short.h5", bytes.substr(0, random() % bytes.size()));
    EXPECT_NE(problems("short.h5"), "");
  }
  const ProgramResult result = program({"verify", "flipped.h5", "out.h5"});
  EXPECT_EQ(result.code, 4) << result.err;
  EXPECT_TRUE(says(result.out, "FAILED  flipped.h5: checksum: ", "ok      out.h5: trials run again: "));
}

TEST_F(Verify, ListsEveryTrialThatDiffers) {
  make("out.h5");
  const fs::path path = copy("changed.h5");
  change_element(path, "/trial/input/friction.k2", 5);
  change_element(path, "/outcome/holding_torque", 2 * 20 + 1);  // point 1, trial 4, move 1
  const std::string found = problems("changed.h5");
  EXPECT_TRUE(says(found, "trials run again: point 0, trial 5: input friction.k2: recorded ",
                   "trials run again: point 1, trial 4: move 1: holding_torque: recorded "));
}

TEST_F(Verify, ChecksPartsOfAStudy) {
  make("a.h5", {"--shard", "1/2"});
  EXPECT_EQ(problems("a.h5"), "");
  change_element(folder_ / "a.h5", "/jerk/duration", 0);
  EXPECT_TRUE(says(problems("a.h5"), "trials run again: point 0, trial "));
}

TEST_F(Verify, ChecksThatTheShardsOfAFolderHoldEachTrialOnce) {
  const fs::path shards = make_shards("out", verified_manifest, 4);
  EXPECT_EQ(problems("out.h5.shards"), "");
  const fs::path second = shards / "trials-000000000008-000000000015.shard";
  fs::copy_file(second, shards / "twice.shard");
  EXPECT_TRUE(
      says(problems("out.h5.shards"), "twice.shard holds trials 8 to 15, which overlap those of trials-"));
  fs::remove(shards / "twice.shard");
  fs::remove(second);
}

TEST_F(Verify, CountsTheMissingTrialsOfAnUnfinishedRun) {
  const fs::path shards = make_shards("out", verified_manifest, 4);
  fs::remove(shards / "trials-000000000008-000000000015.shard");
  const ProgramResult result = program({"verify", "out.h5.shards"});
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  EXPECT_TRUE(says(result.out,
                   "skipped out.h5.shards: all trials: 8 are in none of the shards yet, from trial 8 on"));
}

TEST_F(Verify, NamesForeignAndDamagedShards) {
  const fs::path shards = make_shards("out", verified_manifest, 4);
  const fs::path foreign = make_shards("other", std::string(verified_manifest) + "description: other\n", 4);
  const std::string name = "trials-000000000008-000000000015.shard";
  fs::copy_file(foreign / name, shards / name, fs::copy_options::overwrite_existing);
  fs::remove(shards / "trials-000000000024-000000000031.shard");
  make("out.h5.shards/part.h5", {"--shard", "4/4"});
  change_element(shards / "part.h5", "/outcome/creep", 3);
  const std::string found = problems("out.h5.shards");
  EXPECT_TRUE(says(found, "shards: " + name + " is from another study ('verified') than most",
                   "part.h5: trials run again: point 1, trial 9: move 1: creep"));
}

TEST_F(Verify, AnswersInJson) {
  make("out.h5");
  const ProgramResult result =
      program({"verify", "out.h5", "--format", "json", "--trials", "3", "--seed", "9"});
  EXPECT_EQ(result.code, 0);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["files"][0]["path"], "out.h5");
  EXPECT_EQ(json["files"][0]["checks"].back()["detail"],
            "3 of 32, with inputs, measures, jerks and sample records equal to the bit");
}

TEST_F(Verify, RefusesMissingFilesAndEmptyFolders) {
  EXPECT_EQ(program({"verify", "nothing.h5"}).code, 2);
  fs::create_directory(folder_ / "empty");
  EXPECT_EQ(program({"verify", "empty"}).code, 2);
}

TEST(SampleOfTrials, HasDifferentRowsInOrder) {
  std::vector<int> drawn(20, 0);
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const std::vector<std::int64_t> rows = verification::sample_below(20, 5, seed);
    ASSERT_EQ(rows.size(), 5u);
    ASSERT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    ASSERT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end());
    for (const std::int64_t row : rows) ++drawn.at(static_cast<std::size_t>(row));
  }
  for (const int count : drawn) EXPECT_NEAR(count, 1000, 6 * 27.4);  // six standard deviations, binomial
  EXPECT_EQ(verification::sample_below(4, 9, 1), (std::vector<std::int64_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace zerocount::testing

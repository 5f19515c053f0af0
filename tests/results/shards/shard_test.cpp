#include "results/shards/shard.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/shards/merge.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "tests/results/equality.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Changes the version of the format in a shard file, and makes its checksum right again.
void replace_version(const std::filesystem::path& path, int version) {
  std::string bytes = read_bytes(path);
  bytes.resize(bytes.size() - storage::checksum_trailer_length);
  const std::string start = "zerocount-shard ";
  write_bytes(path, start + std::to_string(version) + bytes.substr(bytes.find(' ', start.size())));
  append_checksum(path);
}

TEST(Shard, ReadsBackWhatWasWritten) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const layout::RowRange rows{35, 50};
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, rows);
  const reading::AllTrialsFile file(shard.path, reading::Require::any_part, nullptr, &study);
  EXPECT_EQ(file.rows(), rows);
  EXPECT_EQ(file.header().manifest, study.manifest.text);
  EXPECT_EQ(file.header().overrides, study.manifest.overrides);
  EXPECT_EQ(file.header().study_sha256, study.study_sha256);
  for (std::int64_t row = rows.first; row < rows.end(); ++row) {
    const shards::TrialResult expected = sample_result(study, row);
    EXPECT_EQ(inputs_of(file, row), expected.inputs);
    expect_equal_records(file.measures(), file.outcomes({row, 1}), expected.outcome.moves);
    std::vector<layout::JerkRecord> jerks;
    for (const trial::Jerk& jerk : expected.jerks) jerks.push_back({jerk, row});
    expect_equal_records(layout::jerk_fields(), file.jerks({row, 1}), jerks);
  }
}

/// Any change of a bit is found before a value is used, and a shard that is cut short by its checksum.
TEST(Shard, IsRefusedIfAnyByteDiffers) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, {0, 20});
  const std::string bytes = read_bytes(shard.path);
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    if (i % 3 == 0) damaged = bytes.substr(0, random() % bytes.size());
    write_bytes(shard.path, damaged);
    EXPECT_THROW(shards::checked_shard(shard.path, study), Failure);
  }
}

/// A damaged head of a shard is refused and does not crash the program, also if its checksum is not verified,
/// as in the command `status`.
TEST(Shard, MalformedHeadersAreRefused) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, {0, 20});
  const std::string bytes = read_bytes(shard.path);
  std::mt19937 random(4);
  for (int i = 0; i < 400; ++i) {
    std::string damaged = bytes.substr(0, i % 2 == 0 ? bytes.size() : random() % 3000);
    for (int k = 0; k < 4; ++k)
      damaged[random() % std::min<std::size_t>(damaged.size(), 2000)] = static_cast<char>(random());
    write_bytes(shard.path, damaged);
    try {
      shards::unchecked_header(shard.path);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_data) << failure.what();
    }
  }
}

TEST(Shard, ADeeplyNestedHeaderIsRefused) {
  const TemporaryFolder directory;
  const std::filesystem::path path = directory.path() / "deep.shard";
  write_bytes(path, "zerocount-shard " + std::to_string(layout::format_version) + " 1000000\n" +
                        std::string(1000000, '\x91'));
  EXPECT_THROW(shards::unchecked_header(path), Failure);
}

/// The columns of a shard by another build may have another meaning.
TEST(Shard, AShardOfAnotherBuildIsNotRead) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, {0, 20});
  std::string bytes = read_bytes(shard.path);
  bytes.resize(bytes.size() - storage::checksum_trailer_length);
  bytes[bytes.find(layout::current_provenance().git_commit)] ^= 1;
  write_bytes(shard.path, bytes);
  append_checksum(shard.path);
  EXPECT_NO_THROW(shards::unchecked_header(shard.path));
  EXPECT_THROW(reading::AllTrialsFile(shard.path, reading::Require::any_part, nullptr, &study),
               layout::ForeignFile);
}

TEST(Shard, HasItsNameOnlyWhenItIsWhole) {
  const TemporaryFolder directory;
  const shards::ShardInfo shard = write_sample_shard(directory.path(), sample_study(), {0, 5});
  EXPECT_TRUE(std::filesystem::exists(shard.path));
  EXPECT_FALSE(std::filesystem::exists(storage::part_of(shard.path)));
}

TEST(Shard, RefusesResultsOfOtherRows) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  std::vector<shards::TrialResult> results = sample_results(study, {0, 5});
  EXPECT_THROW(shards::write_shard(directory / "a.h5", study, {1, std::ssize(results)}, results),
               std::invalid_argument);
  results[3].inputs.pop_back();
  EXPECT_THROW(shards::write_shard(directory / "a.h5", study, {0, std::ssize(results)}, results),
               std::invalid_argument);
  EXPECT_THROW(shards::write_shard(directory / "a.h5", study, {0, 0}, {}), std::invalid_argument);
}

TEST(ShardSurvey, IsEmptyWithoutADirectory) {
  const shards::ShardSurvey survey = shards::list_shards("/nowhere/at/all.shards", sample_study());
  EXPECT_TRUE(survey.shards.empty() && survey.problems.empty() && survey.unfinished.empty());
}

TEST(ShardSurvey, SeparatesGoodShardsFromOthersWithTheReason) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const std::vector<shards::ShardInfo> good = write_sample_shards(directory.path(), study, {0, 30}, 10);
  study::Study other = sample_study(3, 40);
  other.study_sha256 = "0";
  write_bytes(directory / "text.shard", "no shard at all");
  shards::write_shard(directory / "other.shard", other, {40, 5}, sample_results(other, {40, 5}));
  shards::write_shard(directory / "newer.shard", study, {50, 5}, sample_results(study, {50, 5}));
  replace_version(directory / "newer.shard", 99);
  layout::Provenance another = layout::current_provenance();
  another.zerocount_version = "0.0.9";
  shards::write_shard(directory / "earlier.shard", study, {70, 5}, sample_results(study, {70, 5}), {},
                      {another});
  another = layout::current_provenance();
  another.git_commit = std::string(40, '0');
  shards::write_shard(directory / "commit.shard", study, {75, 5}, sample_results(study, {75, 5}), {},
                      {another});
  const std::string whole = read_bytes(good[0].path);
  write_bytes(directory / "short.shard", whole.substr(0, whole.size() / 2));
  write_bytes(directory / "trials-000000000077-000000000078.shard.part", whole.substr(0, 1000));

  const shards::ShardSurvey survey = shards::list_shards(directory.path(), study);
  ASSERT_EQ(survey.shards.size(), good.size());
  for (std::size_t i = 0; i < good.size(); ++i) EXPECT_EQ(survey.shards[i].rows, good[i].rows);
  using Kind = shards::ShardProblem::Kind;
  struct Expected {
    std::string file;
    std::string phrase;
    Kind kind;
  };
  const std::vector<Expected> expected{
      {"commit.shard", "(commit 0000000000000000000000000000000000000000), and this is", Kind::foreign},
      {"earlier.shard", "run by zerocount 0.0.9", Kind::foreign},
      {"newer.shard", "a shard in format version 99, and this program reads version 5", Kind::foreign},
      {"other.shard", "is from another study", Kind::foreign},
      {"short.shard", "checksum at its end is missing", Kind::damaged},
      {"text.shard", "not in the HDF5 format", Kind::damaged}};
  ASSERT_EQ(survey.problems.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const shards::ShardProblem& found = survey.problems[i];
    EXPECT_EQ(found.path.filename(), expected[i].file);
    EXPECT_TRUE(says(found.problem, expected[i].phrase, expected[i].file));
    EXPECT_EQ(found.kind, expected[i].kind) << found.problem;
  }
  ASSERT_EQ(survey.unfinished.size(), 1U);
  shards::remove_unfinished(survey);
  EXPECT_FALSE(std::filesystem::exists(survey.unfinished[0]));
}

TEST(ShardSurvey, IgnoresFilesThatAreNotNamedLikeShards) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, {0, 5});
  std::filesystem::copy_file(shard.path, directory / "trials.shard.damaged");
  directory.write("notes.txt", "mine");
  std::filesystem::create_directory(directory / "folder.shard");
  std::filesystem::create_directory(directory / "folder.part");
  const shards::ShardSurvey survey = shards::list_shards(directory.path(), study);
  EXPECT_EQ(survey.shards.size(), 1U);
  EXPECT_TRUE(survey.problems.empty() && survey.unfinished.empty());
  EXPECT_EQ(shards::shard_files(directory.path()), std::vector<std::filesystem::path>{shard.path});
}

TEST(ShardSurvey, DoesNotTakeAFailureToReadForDamage) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  // To read the memory of a process at address 0 is an I/O error, for root too.
  std::filesystem::create_symlink("/proc/self/mem", directory / "unreadable.shard");
  expect_failure(ExitCode::machine_failed, "unreadable.shard: cannot read: Input/output error",
                 [&] { shards::list_shards(directory.path(), study); });
}

TEST(MissingRanges, AreTheRowsInNoShard) {
  std::mt19937 random(7);
  for (int repetition = 0; repetition < 2000; ++repetition) {
    std::vector<shards::ShardInfo> shards(random() % 6);
    std::set<std::int64_t> covered;
    for (shards::ShardInfo& shard : shards) {
      shard.rows = {static_cast<std::int64_t>(random() % 30), 1 + static_cast<std::int64_t>(random() % 8)};
      for (std::int64_t row = shard.rows.first; row < shard.rows.end(); ++row) covered.insert(row);
    }
    const layout::RowRange wanted{static_cast<std::int64_t>(random() % 10),
                                  static_cast<std::int64_t>(random() % 25)};
    std::set<std::int64_t> missing;
    std::int64_t last_end = -1;
    for (const layout::RowRange& range : shards::missing_ranges(shards, wanted)) {
      EXPECT_GT(range.count, 0);
      EXPECT_GT(range.first, last_end) << "ranges that touch should be one";
      last_end = range.end();
      for (std::int64_t row = range.first; row < range.end(); ++row) missing.insert(row);
    }
    for (std::int64_t row = 0; row < 60; ++row) {
      const bool expected = row >= wanted.first && row < wanted.end() && !covered.contains(row);
      EXPECT_EQ(missing.contains(row), expected) << row;
    }
  }
}

/// Completes a study as the command `run` does: finds the existing shards, and writes the missing rows as
/// shards.
void run_what_is_missing(const std::filesystem::path& directory, const study::Study& study) {
  const shards::ShardSurvey survey = shards::list_shards(directory, study);
  for (const layout::RowRange& range : shards::missing_ranges(survey.shards, layout::all_rows(study)))
    write_sample_shards(directory, study, range, 12);
}

/// Runs `action` in a process that is killed after `delay`; true if the process finished before.
template <class Action>
bool finishes_before(std::chrono::microseconds delay, Action action) {
  const pid_t child = ::fork();
  if (child == 0) {
    action();
    ::_exit(0);
  }
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status);
}

/// Runs the study again and again, killed at random moments, until it finishes. Returns how often it was
/// killed.
int kill_until_finished(const std::filesystem::path& directory, const study::Study& study,
                        std::mt19937& random) {
  int killed = 0;
  std::size_t before = 0;
  for (bool finished = false; !finished && killed < 200;) {
    const auto longest =
        static_cast<unsigned>(10000 * (1 + killed));  // grows, so that slow machines get on too
    const std::chrono::microseconds delay(1000 + random() % longest);
    finished = finishes_before(delay, [&] { run_what_is_missing(directory, study); });
    killed += finished ? 0 : 1;
    const shards::ShardSurvey survey = shards::list_shards(directory, study);
    for (const shards::ShardProblem& problem : survey.problems) ADD_FAILURE() << problem.problem;
    EXPECT_GE(survey.shards.size(), before);
    before = survey.shards.size();
  }
  return killed;
}

void expect_whole_shards(int rounds) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 40, 2);
  const std::filesystem::path reference = write_sample_file(directory.path(), study, 50);
  std::mt19937 random(13);
  int killed = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::filesystem::path shards = directory / fmt::format("shards{}", round);
    const std::filesystem::path output = directory / fmt::format("resumed{}.h5", round);
    std::filesystem::create_directory(shards);
    killed += kill_until_finished(shards, study, random);
    testing::merge_shards(shards::list_shards(shards, study).shards, study, output, layout::all_rows(study),
                          sample_statistics, {sample_provenance()});
    EXPECT_EQ(stored_datasets(output), stored_datasets(reference));
  }
  EXPECT_GE(killed, rounds / 2);
}

TEST(KilledWriter, LeavesOnlyWholeShardsAndTheRunResumes) {
  expect_whole_shards(2);
}

TEST(KilledWriter, DISABLED_LeavesOnlyWholeShardsManyTimes) {
  expect_whole_shards(20);
}

TEST(KilledWriter, AKilledMergeLeavesNoOutputOrAWholeOne) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 40, 2);
  const std::filesystem::path reference = write_sample_file(directory.path(), study, 50);
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 20);
  const std::filesystem::path output = directory / "all.h5";
  std::mt19937 random(17);
  for (int repetition = 0; repetition < 15; ++repetition) {
    const std::chrono::microseconds delay(random() % 60000);
    finishes_before(delay, [&] {
      testing::merge_shards(shards, study, output, layout::all_rows(study), sample_statistics,
                            {sample_provenance()});
    });
    if (!std::filesystem::exists(output)) continue;
    EXPECT_EQ(stored_datasets(output), stored_datasets(reference));
    std::filesystem::remove(output);
  }
}

}  // namespace
}  // namespace zerocount::testing

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "results/layout/header.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// What a run does: looks at what is there, and writes the rest as shards.
void run_what_is_missing(const std::filesystem::path& directory, const study::Study& study) {
  const shards::ShardSurvey survey = shards::list_shards(directory, study);
  for (const layout::RowRange& range : shards::missing_ranges(survey.shards, layout::all_rows(study))) {
    write_sample_shards(directory, study, range, 12);
  }
}

/// Runs `action` in a process that is killed after `delay`; true where it finished before.
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

/// Runs the study again and again, killed at random moments, until it finishes; the number of times it was
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

TEST(KilledWriter, LeavesOnlyWholeShardsAndTheRestResumes) {
  expect_whole_shards(2);
}

TEST(KilledWriter, DISABLED_LeavesOnlyWholeShardsManyTimes) {
  expect_whole_shards(20);
}

TEST(KilledWriter, OfAMergeLeavesNoOutputOrAWholeOne) {
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

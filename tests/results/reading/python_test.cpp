#include "tests/results/samples.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

/// Opens the file with the libraries that its users have; their absence is a failure too.
void expect_python_opens(const std::filesystem::path& path, const std::filesystem::path& output) {
  const reading::AllTrialsFile file(path);
  const std::string command = fmt::format(
      "{} {} {} {} {} {} {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_OPEN_WITH_PYTHON, path.string(),
      file.rows().count, file.moves(), file.jerk_count(), file.trace_count(), output.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << read_bytes(output);
  EXPECT_EQ(read_bytes(output), "opened\n");
}

TEST(Python, OpensAFileWithH5pyXarrayAndNetcdf) {
  const TemporaryFolder directory;
  expect_python_opens(write_sample_file(directory.path(), sample_study()), directory / "output");
}

TEST(Python, OpensAFileWithRigs) {
  const TemporaryFolder directory;
  expect_python_opens(write_sample_file(directory.path(), sample_study_with_rigs()), directory / "output");
}

TEST(Python, OpensAFileWhoseTablesAreEmpty) {
  const TemporaryFolder directory;
  study::Study study = sample_study(1, 4, 1);
  study.manifest.overrides.clear();
  study.profiles.clear();
  study.points.axes.clear();
  std::vector<shards::TrialResult> results(4);
  for (std::int64_t row = 0; row < 4; ++row) {
    results[static_cast<std::size_t>(row)].row = row;
    results[static_cast<std::size_t>(row)].inputs = {1.0, 2.0};
    results[static_cast<std::size_t>(row)].outcome.moves.resize(1);
  }
  shards::write_shard(directory / "shard.h5", study, {0, std::ssize(results)}, results);
  const std::vector<shards::ShardInfo> shards{{directory / "shard.h5", {0, 4}}};
  testing::merge_shards(shards, study, directory / "empty.h5", {0, 4}, {});
  expect_python_opens(directory / "empty.h5", directory / "output");
}

}  // namespace
}  // namespace zerocount::testing

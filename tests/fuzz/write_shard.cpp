// Writes a part with all trials of a manifest but the last: write_shard
// OUTPUT MANIFEST [KEY=VALUE...]

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/study_runner.hpp"
#include "tests/support/temporary_folder.hpp"

int main(int count, char** words) {
  using namespace zerocount;
  try {
    const std::vector<std::string> arguments(words + 1, words + count);
    const study::Study study =
        manifest::load_study(arguments.at(1), {arguments.begin() + 2, arguments.end()});
    const std::filesystem::path output = arguments.at(0);
    const testing::TemporaryFolder folder;
    const std::vector<layout::RowRange> rows{{0, study::trial_count(study) - 1}};
    const auto shards = trials::run_trials(study, rows, folder.path(), {}, {}).shards;
    study_run::assemble(shards, study, output, rows.front());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_shard: %s\n", error.what());
    return 1;
  }
  return 0;
}

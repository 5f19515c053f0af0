// Writes a shard with all trials of a manifest: write_shard OUTPUT MANIFEST [KEY=VALUE...]

#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "experiments/manifest/load_study.hpp"
#include "results/shards/shard.hpp"
#include "runners/study_run/study_runner.hpp"

int main(int count, char** words) {
  using namespace zerocount;
  try {
    const std::vector<std::string> arguments(words + 1, words + count);
    const study::Study study =
        manifest::load_study(arguments.at(1), {arguments.begin() + 2, arguments.end()});
    std::vector<shards::TrialResult> results;
    for (std::int64_t row = 0; row < study::trial_count(study); ++row)
      results.push_back(study_run::run_study_trial(study, row));
    shards::write_shard(arguments.at(0), study, 0, results);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_shard: %s\n", error.what());
    return 1;
  }
  return 0;
}

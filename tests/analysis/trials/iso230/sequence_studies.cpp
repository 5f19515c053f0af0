#include "tests/analysis/trials/iso230/sequence_studies.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "analysis/trials/iso230/results_group.hpp"
#include "analysis/trials/summary/stored_statistics.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/shards/merge.hpp"

namespace zerocount::testing {

study::Study sequence_study(const std::string& sequence, std::int64_t trials, const std::string& more) {
  return manifest::parse_study(
      fmt::format("zerocount: 1\n"
                  "name: back and forth\n"
                  "seed: 230\n"
                  "trials: {}\n"
                  "command:\n"
                  "  sequence: {{targets: [-30, {{integers: [-3, 3]}}, 700], overrun: 10, {}}}\n"
                  "  hold: 0.1\n"
                  "initial: {{encoder_phase: {{uniform: [0, 1]}}}}\n"
                  "sweep: {{cases: {{fine: {{encoder.fine: 1620000}},\n"
                  "                 \"rough, wide\": {{encoder.fine: 810000}}}}}}\n{}",
                  trials, sequence, more),
      "test");
}

std::vector<shards::TrialResult> sequence_results(const study::Study& study) {
  std::mt19937_64 random(14);
  std::normal_distribution<double> normal(0.0, 1.5);
  std::vector<shards::TrialResult> results;
  for (std::int64_t row = 0; row < study::trial_count(study); ++row) {
    const study::StudyTrial trial = study::study_trial(study, row / study.trials, row % study.trials);
    const trial::TrialParameters& p = trial.parameters;
    const double resolution = 2.0 * std::numbers::pi / p.encoder.fine;
    const bool exact = row % 7 == 0;
    shards::TrialResult& result = results.emplace_back();
    result.row = row;
    result.inputs = trial.inputs;
    for (const std::int64_t target : p.command.targets) {
      trial::MoveOutcome& move = result.outcome.moves.emplace_back();
      const double counts = static_cast<double>(target) + 0.5 + (exact ? 0.0 : normal(random));
      move.outcome = trial::Outcome::zero_count;
      move.final_position = (counts - p.initial.encoder_phase) * resolution;
      move.final_error = target - static_cast<std::int64_t>(std::floor(counts));
    }
  }
  return results;
}

void write_sequence_file(const std::filesystem::path& path, const study::Study& study,
                         const std::vector<shards::TrialResult>& results) {
  const std::filesystem::path shard = path.string() + ".shard.h5";
  shards::write_shard(shard, study, {0, std::ssize(results)}, results);
  const layout::RowRange rows{0, static_cast<std::int64_t>(results.size())};
  shards::MergedFile file(std::vector<shards::ShardInfo>{{shard, rows}}, study, path, rows);
  summary::take_stored_statistics(
      file.trials(), study, {}, [&](const layout::StoredStatistics& block) { file.write_statistics(block); });
  if (!study.sequence.empty()) iso230::write_repeatability(file.file(), study);
  file.finish();
}

}  // namespace zerocount::testing

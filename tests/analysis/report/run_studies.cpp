#include "tests/analysis/report/run_studies.hpp"

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/summary/study_statistics.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/shards/merge.hpp"

namespace zerocount::testing {

std::string rich_manifest(int trials, const std::string& description) {
  return fmt::format(
      "zerocount: 1\nname: rich\ndescription: {}\nseed: 7\ntrials: {}\n"
      "friction:\n"
      "  k1: {{profile: {{mean: 110, cv: 0.15, correlation_length: 0.3, marginal: lognormal}}}}\n"
      "  k2: {{uniform: [600, 900]}}\n"
      "  lambda: 0.5\n"
      "command: {{targets: [{{integers: [1, 10]}}], hold: 0.15}}\n"
      "initial: {{encoder_phase: {{uniform: [0, 1]}}, position: {{uniform: [0, 6.283185307179586]}}}}\n"
      "verdict: {{dwell: 0.02, window: 0.02}}\n"
      "sweep: {{grid: {{controller.kp: [0, 4.0e-4], controller.ki: {{logspace: [2.0e-5, 3.0e-4, 4]}}}}}}\n",
      nlohmann::json(description).dump(), trials);
}

Study run_study_file(const std::filesystem::path& path, const std::string& manifest) {
  Study study = parse_study(manifest, "test");
  study.engine = Engine::reference;
  std::vector<TrialResult> results;
  for (std::int64_t row = 0; row < trial_count(study); ++row) {
    const StudyTrial trial = study_trial(study, row / study.trials, row % study.trials);
    TrialResult& result = results.emplace_back();
    result.row = row;
    result.inputs = trial.inputs;
    TrialObservers observers;
    observers.jerk = [&](const Jerk& jerk) { result.jerks.push_back(jerk); };
    result.outcome = run_trial(trial.parameters, observers);
  }
  const std::filesystem::path shard = path.string() + ".shard.h5";
  write_shard(shard, study, 0, results);
  const RowRange rows{0, trial_count(study)};
  merge_shards(std::vector<ShardInfo>{{shard, rows}}, study, path, rows,
               [&study](const StudyFile& file) { return stored_statistics(file, study); });
  return study;
}

}  // namespace zerocount::testing

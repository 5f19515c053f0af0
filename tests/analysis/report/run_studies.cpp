#include "tests/analysis/report/run_studies.hpp"

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/trials/summary/stored_statistics.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
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

std::size_t times_in(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++times;
  return times;
}

study::Study run_study_file(const std::filesystem::path& path, const std::string& manifest) {
  study::Study study = manifest::parse_study(manifest, "test");
  study.engine = study::Engine::reference;
  std::vector<shards::TrialResult> results;
  for (std::int64_t row = 0; row < study::trial_count(study); ++row) {
    const study::StudyTrial trial = study::study_trial(study, row / study.trials, row % study.trials);
    shards::TrialResult& result = results.emplace_back();
    result.row = row;
    result.inputs = trial.inputs;
    trial::TrialObservers observers;
    observers.jerk = [&](const trial::Jerk& jerk) { result.jerks.push_back(jerk); };
    result.outcome = trial::run_trial(trial.parameters, observers);
  }
  const std::filesystem::path shard = path.string() + ".shard.h5";
  shards::write_shard(shard, study, {0, std::ssize(results)}, results);
  const layout::RowRange rows{0, study::trial_count(study)};
  shards::MergedFile file(std::vector<shards::ShardInfo>{{shard, rows}}, study, path, rows);
  summary::take_stored_statistics(
      file.trials(), study, {}, [&](const layout::StoredStatistics& block) { file.write_statistics(block); });
  file.finish();
  return study;
}

}  // namespace zerocount::testing

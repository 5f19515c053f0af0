#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

/// Counts the successful trials of every design point, in blocks of StoppingRule::block trials.
class Successes {
 public:
  explicit Successes(const study::Study& study)
      : study_(study), by_block_(static_cast<std::size_t>(study::point_count(study))) {}

  void add(const shards::ShardInfo& shard) {
    const reading::AllTrialsFile file(shard.path, reading::Require::any_part, nullptr, &study_);
    const std::vector<trial::MoveOutcome> outcomes = file.outcomes(file.rows());
    for (std::int64_t i = 0; i < file.rows().count; ++i) {
      const auto first = outcomes.begin() + i * study_.moves;
      if (trial::succeeded(std::span(first, first + study_.moves))) count(file.rows().first + i);
    }
  }

  /// Number of successful trials among the first `trials` trials of a design point. `trials` must be a whole
  /// number of blocks.
  std::int64_t among(std::int64_t point, std::int64_t trials) const {
    const std::vector<std::int64_t>& blocks = by_block_[static_cast<std::size_t>(point)];
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (static_cast<std::int64_t>(i) * study_.stop->block < trials) sum += blocks[i];
    }
    return sum;
  }

 private:
  void count(std::int64_t row) {
    std::vector<std::int64_t>& blocks = by_block_[static_cast<std::size_t>(row / study_.trials)];
    const auto block = static_cast<std::size_t>(row % study_.trials / study_.stop->block);
    if (blocks.size() <= block) blocks.resize(block + 1, 0);
    ++blocks[block];
  }

  const study::Study& study_;
  std::vector<std::vector<std::int64_t>> by_block_;
};

bool sure(const study::Study& study, const Successes& successes, std::int64_t trials) {
  const study::StoppingRule& rule = *study.stop;
  if (trials < rule.min_trials) return false;
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    const statistics::ConfidenceInterval bounds =
        statistics::confidence_sequence_bounds(successes.among(point, trials), trials, rule.confidence);
    if (0.5 * (bounds.high - bounds.low) > rule.success_rate_halfwidth) return false;
  }
  return true;
}

/// Projected number of trials per point that the stopping rule needs, at the success rates so far.
std::int64_t projection(const study::Study& study, const Successes& successes, std::int64_t trials) {
  const study::StoppingRule& rule = *study.stop;
  std::int64_t most = std::max(trials, std::min(rule.min_trials, study.trials));
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    most = std::max(most, statistics::projected_trials(successes.among(point, trials), trials,
                                                       rule.success_rate_halfwidth, rule.confidence,
                                                       rule.block, study.trials));
  }
  return most;
}

/// Rows of the first `trials` trials of each design point. A row is the number of a trial in a study with the
/// maximum number of trials.
std::vector<layout::RowRange> first_trials(const study::Study& study, std::int64_t trials) {
  std::vector<layout::RowRange> ranges;
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    ranges.push_back({point * study.trials, trials});
  }
  return ranges;
}

std::vector<layout::RowRange> missing(const study::Study& study, const std::vector<shards::ShardInfo>& shards,
                                      std::int64_t trials) {
  std::vector<layout::RowRange> all;
  for (const layout::RowRange& range : first_trials(study, trials)) {
    const std::vector<layout::RowRange> here = shards::missing_ranges(shards, range);
    all.insert(all.end(), here.begin(), here.end());
  }
  return all;
}

study::Study decided_study(const study::Study& study, std::int64_t trials) {
  std::vector<std::string> overrides = study.manifest.overrides;
  overrides.push_back(fmt::format("{}{}", decided_key, trials));
  study::Study decided =
      manifest::parse_study(study.manifest.text, study.name, overrides, sections::external_inputs_of(study));
  decided.engine = study.engine;
  return decided;
}

/// Joins the shards, whose rows are those of `study`, into the results file of `decided`, the study with the
/// number of trials on which the stopping rule decided.
void assemble_decided(const std::vector<shards::ShardInfo>& shards, const study::Study& study,
                      const study::Study& decided, const fs::path& output, const AssembleSettings& common) {
  const auto renumber = [&](std::int64_t row) {
    return row / study.trials * decided.trials + row % study.trials;
  };
  std::vector<shards::ShardInfo> renumbered;
  renumbered.reserve(shards.size());
  for (const shards::ShardInfo& shard : shards) {
    renumbered.push_back({shard.path, {renumber(shard.rows.first), shard.rows.count}});
  }
  AssembleSettings with_rows = common;
  with_rows.renumber = renumber;
  assemble(renumbered, decided, output, layout::all_rows(decided), with_rows);
}

}  // namespace

void run_sequential(const FileRun& request, const std::stop_token& stop) {
  const study::Study& study = request.study;
  const fs::path directory = layout::shards_directory(request.output);
  storage::make_directory(directory);
  EarlierShards earlier = earlier_shards(directory, study, request.wanted, request.foreign);
  std::vector<shards::ShardInfo> shards = std::move(earlier.usable);
  Successes successes(study);
  std::int64_t done = 0;
  for (const shards::ShardInfo& shard : shards) {
    successes.add(shard);
    done += shard.rows.count;
  }
  status::Progress progress(study::point_count(study) * study.trials, done, trials::samples_per_trial(study),
                            request.quiet, request.listener);
  trials::RunSettings run;
  run.threads = request.threads;
  run.timeline = request.timeline;
  run.finished = [&](std::int64_t trials) { progress.update(done += trials); };

  std::int64_t trials = 0;
  do {
    trials = std::min(trials + study.stop->block, study.trials);
    const std::vector<layout::RowRange> ranges = missing(study, shards, trials);
    const std::int64_t before = done;
    trials::FinishedTrials finished = trials::run_trials(study, ranges, directory, run, stop);
    for (shards::ShardInfo& shard : finished.shards) {
      successes.add(shard);
      shards.push_back(std::move(shard));
    }
    shards::sort_by_rows(shards);
    if (done - before < layout::total_rows(ranges)) {
      throw Failure(ExitCode::interrupted,
                    fmt::format("interrupted: {} trials are kept in {}; give the same command again to go on",
                                done, directory.string()));
    }
    progress.project(study::point_count(study) * projection(study, successes, trials));
  } while (trials < study.trials && !sure(study, successes, trials));
  progress.project(study::point_count(study) * trials);
  progress.finish(done);

  assemble_decided(shards, study, decided_study(study, trials), request.output,
                   {.stop = stop, .timeline = request.timeline});
  for (const shards::ShardInfo& shard : shards) earlier.all.push_back(shard.path);
  remove_shards(directory, earlier.all);
  if (!request.quiet) {
    const char* const why = sure(study, successes, trials)
                                ? "all success rates are known as well as requested"
                                : "max_trials; some success rates are known less well than requested";
    status::tell("wrote {}: {} trials at each point ({})\n", request.output.string(), trials, why);
  }
}

}  // namespace zerocount::study_run

#include "runners/study_run/study_runner.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/summary/study_statistics.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/merge.hpp"
#include "runners/study_run/shard_clock.hpp"
#include "runners/study_run/sums_writer.hpp"
#include "runners/study_run/trial_runner.hpp"

namespace zerocount::study_run {
namespace {

/// Limits of a block. It takes a fraction of a second, so that interruptions are handled quickly and the
/// threads end together. The batch engine needs many trials per block, because the last ones do not fill its
/// lanes.
struct BlockLimits {
  double samples;
  std::int64_t trials;
};
constexpr BlockLimits reference_block{1e5, 256};
constexpr BlockLimits batch_block{1e7, 4096};

/// A block ends with the trial whose trace takes the traces of its retained trials beyond this size.
constexpr std::size_t max_trace_bytes_per_block = std::size_t{8} << 20;

constexpr std::size_t max_trials_per_shard = 1 << 16;
constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
/// Bytes of the trace of a retained trial in memory.
double bytes_of_trace(const study::Study& study) {
  return study.retained_trials.empty() ? 0.0 : samples_per_trial(study) * sizeof(trial::SampleRecord);
}

/// Divides the ranges into blocks of rows. A block belongs to one range. It has fewer trials where many of
/// them are retained with their traces.
class BlockSource {
 public:
  BlockSource(const study::Study& study, std::span<const layout::RowRange> ranges, std::int64_t block_size)
      : study_(study), ranges_(ranges), block_size_(block_size), trace_bytes_(bytes_of_trace(study)) {}

  std::optional<layout::RowRange> next() {
    while (at_ < ranges_.size() && used_ == ranges_[at_].count) {
      ++at_;
      used_ = 0;
    }
    if (at_ == ranges_.size()) return std::nullopt;
    const layout::RowRange block =
        with_few_traces({ranges_[at_].first + used_, std::min(block_size_, ranges_[at_].count - used_)});
    used_ += block.count;
    return block;
  }

 private:
  layout::RowRange with_few_traces(layout::RowRange rows) const {
    double bytes = 0.0;
    for (std::int64_t i = 0; i < rows.count; ++i) {
      if (is_retained(study_, (rows.first + i) % study_.trials)) bytes += trace_bytes_;
      if (bytes > static_cast<double>(max_trace_bytes_per_block)) return {rows.first, i + 1};
    }
    return rows;
  }

  const study::Study& study_;
  std::span<const layout::RowRange> ranges_;
  std::int64_t block_size_;
  double trace_bytes_;  ///< of one retained trial
  std::size_t at_{0};
  std::int64_t used_{0};
};

/// Collects finished trials in order of rows and writes them as shards.
///
/// A shard ends at the end of a chunk of the results file if it can: the file then takes over its compressed
/// chunks, of all tables with a row a trial whose chunks begin where the shard does. The other shards are not
/// compressed, because their values are compressed again for the file. Trials left after such a shard may
/// wait twice as long.
class ShardWriter {
 public:
  ShardWriter(const study::Study& study, std::filesystem::path directory)
      : study_(study), directory_(std::move(directory)), provenance_(layout::current_provenance()) {}

  void take(std::vector<shards::TrialResult>&& block) {
    if (block.empty()) return;
    if (!waiting_.empty() && block.front().row != waiting_.back().row + 1) flush();
    if (waiting_.empty()) clock_.begin_shard();
    for (const shards::TrialResult& result : block) bytes_ += bytes_of(result);
    waiting_.insert(waiting_.end(), std::make_move_iterator(block.begin()),
                    std::make_move_iterator(block.end()));
    if (waiting_.size() < max_trials_per_shard && bytes_ < max_bytes_per_shard && !clock_.waited_enough())
      return;
    const std::size_t in_chunks = trials_in_chunks();
    write(in_chunks > 0 ? in_chunks : waiting_.size());
  }

  void flush() {
    if (!waiting_.empty()) write(waiting_.size());
  }

  const std::vector<shards::ShardInfo>& written() const { return written_; }

 private:
  const study::Study& study_;
  std::filesystem::path directory_;
  layout::Provenance provenance_;

  /// Number of the waiting trials up to the end of the last whole chunk of a whole study.
  std::size_t trials_in_chunks() const {
    const std::int64_t first = waiting_.front().row;
    const std::int64_t end = first + std::ssize(waiting_);
    return static_cast<std::size_t>(std::max<std::int64_t>(end - end % layout::chunk_elements - first, 0));
  }

  /// Writes the first `count` of the waiting trials.
  void write(std::size_t count) {
    const std::span<const shards::TrialResult> trials = std::span(waiting_).first(count);
    const layout::RowRange rows{trials.front().row, std::ssize(trials)};
    const bool in_chunks = rows.first % layout::chunk_elements == 0 && trials_in_chunks() > 0;
    written_.push_back({shards::shard_path(directory_, rows), rows});
    shards::write_shard(written_.back().path, study_, rows.first, trials, provenance_,
                        in_chunks ? hdf5::Compression::deflate : hdf5::Compression::none);
    waiting_.erase(waiting_.begin(), waiting_.begin() + std::ssize(trials));
    bytes_ = 0;
    for (const shards::TrialResult& trial : waiting_) bytes_ += bytes_of(trial);
    clock_.begin_shard();
  }

  std::vector<shards::TrialResult> waiting_;
  std::vector<shards::ShardInfo> written_;
  std::size_t bytes_{0};
  ShardClock clock_;
};

/// Number of trials per block in a run of `rows` trials.
std::int64_t block_size_of(const study::Study& study, std::int64_t rows, int threads) {
  const BlockLimits limits = study.engine == study::Engine::batch ? batch_block : reference_block;
  const double size = limits.samples / std::max(samples_per_trial(study), 1.0);
  // Divides a short run among all threads.
  const std::int64_t proportion = rows / (std::int64_t{4} * threads) + 1;
  return std::clamp(static_cast<std::int64_t>(size), std::int64_t{1},
                    std::min(limits.trials, std::max<std::int64_t>(proportion, 256)));
}

/// Runs the blocks of `ranges` in parallel. `digest` turns a block into what `take` gets, one at a time in
/// order of rows.
template <class Digest, class Take>
void run_blocks(const study::Study& study, std::span<const layout::RowRange> ranges, int threads,
                const std::stop_token& stop, const Digest& digest, const Take& take) {
  namespace tbb = oneapi::tbb;
  using Product = std::shared_ptr<std::invoke_result_t<Digest, TrialBlock&&>>;
  BlockSource source(study, ranges, block_size_of(study, layout::total_rows(ranges), threads));
  const auto next_block = [&](tbb::flow_control& control) -> layout::RowRange {
    std::optional<layout::RowRange> block = stop.stop_requested() ? std::nullopt : source.next();
    if (!block) {
      control.stop();
      return {};
    }
    return *block;
  };
  tbb::enumerable_thread_specific<TrialRunner> runners([&study] { return TrialRunner(study); });
  const auto run_block = [&](layout::RowRange rows) -> Product {
    try {
      return std::make_shared<typename Product::element_type>(digest(runners.local().run_block(rows, stop)));
    } catch (const trial::Interrupted&) {
      return nullptr;  // the trials of the block are run again
    }
  };
  const auto take_block = [&](const Product& product) {
    if (product) take(std::move(*product));
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(
        4 * static_cast<std::size_t>(threads),
        tbb::make_filter<void, layout::RowRange>(tbb::filter_mode::serial_in_order, next_block) &
            tbb::make_filter<layout::RowRange, Product>(tbb::filter_mode::parallel, run_block) &
            tbb::make_filter<Product, void>(tbb::filter_mode::serial_in_order, take_block));
  };
  tbb::task_arena(threads).execute(pipeline);
}

FinishedTrials run_trials_kept(const study::Study& study, std::span<const layout::RowRange> ranges,
                               const std::filesystem::path& directory, int threads,
                               const std::function<void(std::int64_t)>& finished,
                               const std::stop_token& stop) {
  ShardWriter writer(study, directory);
  std::vector<theory::PointPrediction> predictions(static_cast<std::size_t>(study::point_count(study)));
  const auto take = [&](TrialBlock&& block) {
    const auto trials = std::ssize(block.results);
    const auto first_point = static_cast<std::size_t>(block.results.front().row / study.trials);
    for (std::size_t i = 0; i < block.predictions.size(); ++i)
      predictions[first_point + i] = predictions[first_point + i] + block.predictions[i];
    writer.take(std::move(block.results));
    finished(trials);
  };
  run_blocks(
      study, ranges, threads, stop, [](TrialBlock&& block) { return std::move(block); }, take);
  writer.flush();
  return {writer.written(), std::move(predictions)};
}

FinishedTrials run_trials_summed(const study::Study& study, std::span<const layout::RowRange> ranges,
                                 const std::filesystem::path& directory, int threads,
                                 const std::function<void(std::int64_t)>& finished,
                                 const std::stop_token& stop) {
  SumsWriter writer(study, directory);
  const auto take = [&](SummedBlock&& block) {
    const std::int64_t trials = block.rows.count;
    writer.take(std::move(block));
    finished(trials);
  };
  run_blocks(
      study, ranges, threads, stop, [&](TrialBlock&& block) { return sum_block(study, std::move(block)); },
      take);
  writer.flush();
  return {writer.written(), {}};
}

}  // namespace

int threads_to_use(int asked) {
  return asked > 0 ? asked : oneapi::tbb::info::default_concurrency();
}

std::size_t bytes_of(const shards::TrialResult& result) {
  return sizeof result + result.inputs.size() * sizeof(double) +
         result.outcome.moves.size() * sizeof(trial::MoveOutcome) +
         result.jerks.size() * sizeof(trial::Jerk) + result.trace.size() * sizeof(trial::SampleRecord);
}

double samples_per_trial(const study::Study& study) {
  double total = 0.0;
  const std::int64_t asked = std::min<std::int64_t>(study::point_count(study), 64);
  for (std::int64_t i = 0; i < asked; ++i) {
    const trial::TrialParameters parameters =
        study::study_trial(study, i * study::point_count(study) / asked, 0).parameters;
    total += static_cast<double>(trial::samples_of_trial(parameters));
  }
  return total / static_cast<double>(asked);
}

double peak_memory(const study::Study& study, double bytes_of_trial, double record_bytes, int threads) {
  constexpr double program = 40e6;  // program, libraries, lanes and statistics; measured
  const int workers = threads_to_use(threads);
  const std::int64_t rows = study::trial_count(study);
  const double in_work = 4.0 * workers * static_cast<double>(block_size_of(study, rows, workers));
  const double waiting = std::min(static_cast<double>(max_trials_per_shard),
                                  static_cast<double>(max_bytes_per_shard) / bytes_of_trial);
  // Writing a shard copies its columns.
  const double records = std::min(record_bytes, static_cast<double>(max_bytes_per_shard));
  const double block_traces = static_cast<double>(max_trace_bytes_per_block) + bytes_of_trace(study);
  return program + 3.0 * records + std::min(record_bytes, 4.0 * workers * block_traces) +
         bytes_of_trial * std::min(in_work + 2.0 * waiting, 3.0 * static_cast<double>(rows));
}

FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop) {
  namespace tbb = oneapi::tbb;
  const int threads = threads_to_use(settings.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const auto finished = [&](std::int64_t trials) {
    if (settings.finished) settings.finished(trials);
  };
  return study.kept == study::Kept::trials
             ? run_trials_kept(study, ranges, directory, threads, finished, stop)
             : run_trials_summed(study, ranges, directory, threads, finished, stop);
}

void assemble(std::span<const shards::ShardInfo> shards, const study::Study& study,
              const std::filesystem::path& output, layout::RowRange rows,
              std::span<const theory::PointPrediction> predictions, const shards::Renumbering& renumber) {
  if (study.kept != study::Kept::trials) {
    assemble_statistics(shards, study, output, rows);
    return;
  }
  const auto statistics = [&](const reading::StudyFile& file) {
    return summary::stored_statistics(file, study, predictions);
  };
  shards::merge_shards(shards, study, output, rows, statistics, layout::current_provenance(), renumber);
}

}  // namespace zerocount::study_run

#include "runners/study_run/study_runner.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "runners/study_run/trial_runner.hpp"

namespace zerocount {
namespace {

using Block = std::shared_ptr<std::vector<TrialResult>>;

/// A block takes a fraction of a second, so that an interruption is answered soon and the threads end
/// together. The lanes of the batch engine want many trials, because the last of them run alone.
struct BlockLimits {
  double samples;
  std::int64_t trials;
};
constexpr BlockLimits reference_block{1e5, 256};
constexpr BlockLimits batch_block{1e7, 4096};

constexpr std::size_t max_trials_per_shard = 1 << 16;
constexpr std::size_t max_bytes_per_shard = std::size_t{64} << 20;
/// A shard waits for a tenth of the time that the run has taken, within these bounds: a crash loses little,
/// and a long run does not end in thousands of files.
constexpr std::chrono::duration<double> shortest_wait{0.5};
constexpr std::chrono::duration<double> longest_wait{20.0};

/// Hands out the rows of the ranges in blocks that do not cross from one range into the next.
class BlockSource {
 public:
  BlockSource(std::span<const RowRange> ranges, std::int64_t block_size)
      : ranges_(ranges), block_size_(block_size) {}

  std::optional<RowRange> next() {
    while (at_ < ranges_.size() && used_ == ranges_[at_].count) {
      ++at_;
      used_ = 0;
    }
    if (at_ == ranges_.size()) return std::nullopt;
    const RowRange block{ranges_[at_].first + used_, std::min(block_size_, ranges_[at_].count - used_)};
    used_ += block.count;
    return block;
  }

 private:
  std::span<const RowRange> ranges_;
  std::int64_t block_size_;
  std::size_t at_{0};
  std::int64_t used_{0};
};

/// Gathers finished trials in order of rows and writes them as shards.
class ShardWriter {
 public:
  using Clock = std::chrono::steady_clock;

  ShardWriter(const Study& study, std::filesystem::path directory)
      : study_(study), directory_(std::move(directory)), provenance_(current_provenance()) {}

  void take(std::vector<TrialResult>&& block) {
    if (block.empty()) return;
    if (!waiting_.empty() && block.front().row != waiting_.back().row + 1) flush();
    if (waiting_.empty()) begun_ = Clock::now();
    for (const TrialResult& result : block) bytes_ += bytes_of(result);
    waiting_.insert(waiting_.end(), std::make_move_iterator(block.begin()),
                    std::make_move_iterator(block.end()));
    if (waiting_.size() >= max_trials_per_shard || bytes_ >= max_bytes_per_shard || waited_enough()) flush();
  }

  void flush() {
    if (waiting_.empty()) return;
    const RowRange rows{waiting_.front().row, static_cast<std::int64_t>(waiting_.size())};
    written_.push_back({shard_path(directory_, rows), rows});
    write_shard(written_.back().path, study_, rows.first, waiting_, provenance_);
    waiting_.clear();
    bytes_ = 0;
  }

  const std::vector<ShardInfo>& written() const { return written_; }

 private:
  const Study& study_;
  std::filesystem::path directory_;
  Provenance provenance_;
  bool waited_enough() const {
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> proportion = 0.1 * (now - run_begun_);
    return now - begun_ >= std::clamp(proportion, shortest_wait, longest_wait);
  }

  std::vector<TrialResult> waiting_;
  std::vector<ShardInfo> written_;
  std::size_t bytes_{0};
  Clock::time_point begun_;
  Clock::time_point run_begun_{Clock::now()};
};

/// Trials that a thread takes at once, of a run of `rows` trials.
std::int64_t block_size_of(const Study& study, std::int64_t rows, int threads) {
  const BlockLimits limits = study.engine == Engine::batch ? batch_block : reference_block;
  const double size = limits.samples / std::max(samples_per_trial(study), 1.0);
  // A short run is spread over the threads, too.
  const std::int64_t proportion = rows / (std::int64_t{4} * threads) + 1;
  return std::clamp(static_cast<std::int64_t>(size), std::int64_t{1},
                    std::min(limits.trials, std::max<std::int64_t>(proportion, 256)));
}

int threads_to_use(int asked) {
  return asked > 0 ? asked : oneapi::tbb::info::default_concurrency();
}

}  // namespace

std::size_t bytes_of(const TrialResult& result) {
  return sizeof result + result.inputs.size() * sizeof(double) +
         result.outcome.moves.size() * sizeof(MoveOutcome) + result.jerks.size() * sizeof(Jerk) +
         result.trace.size() * sizeof(SampleRecord);
}

double samples_per_trial(const Study& study) {
  double total = 0.0;
  const std::int64_t asked = std::min<std::int64_t>(point_count(study), 64);
  for (std::int64_t i = 0; i < asked; ++i) {
    const TrialParameters parameters = study_trial(study, i * point_count(study) / asked, 0).parameters;
    total += static_cast<double>(samples_of_trial(parameters));
  }
  return total / static_cast<double>(asked);
}

double peak_memory(const Study& study, double bytes_of_trial, double record_bytes, int threads) {
  constexpr double program = 40e6;  // with its libraries, the lanes and the statistics; measured
  const int workers = threads_to_use(threads);
  const std::int64_t rows = trial_count(study);
  const double in_work = 4.0 * workers * static_cast<double>(block_size_of(study, rows, workers));
  const double waiting = std::min(static_cast<double>(max_trials_per_shard),
                                  static_cast<double>(max_bytes_per_shard) / bytes_of_trial);
  // A shard is written from copies of its columns.
  const double records = std::min(record_bytes, static_cast<double>(max_bytes_per_shard));
  return program + 3.0 * records +
         bytes_of_trial * std::min(in_work + 2.0 * waiting, 3.0 * static_cast<double>(rows));
}

std::vector<ShardInfo> run_trials(const Study& study, std::span<const RowRange> ranges,
                                  const std::filesystem::path& directory, const RunSettings& settings,
                                  std::stop_token stop) {
  namespace tbb = oneapi::tbb;
  const int threads = threads_to_use(settings.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));

  BlockSource source(ranges, block_size_of(study, total_rows(ranges), threads));
  ShardWriter writer(study, directory);

  const auto next_block = [&](tbb::flow_control& control) -> RowRange {
    std::optional<RowRange> block = stop.stop_requested() ? std::nullopt : source.next();
    if (!block) {
      control.stop();
      return {};
    }
    return *block;
  };
  tbb::enumerable_thread_specific<TrialRunner> runners([&study] { return TrialRunner(study); });
  const auto run_block = [&](RowRange rows) {
    return std::make_shared<std::vector<TrialResult>>(runners.local().run(rows));
  };
  const auto write_block = [&](const Block& block) {
    const auto trials = static_cast<std::int64_t>(block->size());
    writer.take(std::move(*block));
    if (settings.finished) settings.finished(trials);
  };
  const auto pipeline = [&] {
    tbb::parallel_pipeline(4 * static_cast<std::size_t>(threads),
                           tbb::make_filter<void, RowRange>(tbb::filter_mode::serial_in_order, next_block) &
                               tbb::make_filter<RowRange, Block>(tbb::filter_mode::parallel, run_block) &
                               tbb::make_filter<Block, void>(tbb::filter_mode::serial_in_order, write_block));
  };
  tbb::task_arena(threads).execute(pipeline);
  writer.flush();
  return writer.written();
}

}  // namespace zerocount

#include "runners/trials/study_runner.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/measures/point_columns.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/header.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/encoded_shard.hpp"
#include "runners/trials/kept_block.hpp"
#include "runners/trials/shard_collector.hpp"
#include "runners/trials/trial_runner.hpp"
#include "runners/trials/turn_clock.hpp"
#include "runners/trials/turns.hpp"

namespace zerocount::trials {
namespace {

/// Limits of a block. It takes a fraction of a second, so that interruptions are handled quickly and the
/// threads end together. The batch engine needs many trials per block, because the last ones do not fill its
/// lanes.
struct BlockLimits {
  double samples;
  std::int64_t trials;
};
constexpr BlockLimits reference_block{1e5, 256};
constexpr BlockLimits batch_block{1e7, 1024};

/// A block ends with the trial whose trace takes the traces of its retained trials beyond this size.
constexpr std::size_t max_trace_bytes_per_block = std::size_t{8} << 20;

/// Bytes of the trace of a retained trial in memory.
double bytes_of_trace(const study::Study& study) {
  return study.retained_trials.empty() ? 0.0 : samples_per_trial(study) * sizeof(trial::SampleRecord);
}

/// Rows that one thread runs.
struct Block {
  layout::RowRange rows;
  bool begins_turn{false};
};

/// Divides the rows of all turns into blocks. A block ends with a chunk of the results file, and has fewer
/// trials where many of them are retained with their traces.
class BlockSource {
 public:
  BlockSource(const study::Study& study, Turns turns, std::int64_t block_size, int threads)
      : study_(study),
        turns_(std::move(turns)),
        clock_(turns_.points(), threads),
        block_size_(block_size),
        trace_bytes_(bytes_of_trace(study)) {}

  std::optional<Block> next() {
    if (turns_.is_empty()) return std::nullopt;
    const bool begins_turn = clock_.progress() >= end_of_turn();
    if (begins_turn) {
      turns_.end_turn();
      clock_.begin_turn();
    }
    const std::int64_t max_rows = layout::chunk_elements - next_row() % layout::chunk_elements;
    const layout::RowRange rows = with_few_traces(turns_.upcoming(std::min(block_size_, max_rows)));
    turns_.take(rows.count);
    return Block{rows, begins_turn};
  }

 private:
  std::int64_t next_row() const { return turns_.upcoming(1).first; }

  /// Progress of a turn at which it ends here. Short points share a turn, and a point that takes most of one
  /// has its shard to itself. Shards that begin with a chunk are cheap to join (ShardWriter).
  double end_of_turn() const {
    if (turns_.is_at_new_point()) return 0.5;
    return next_row() % layout::chunk_elements == 0 ? 1.0 : 1.5;
  }

  layout::RowRange with_few_traces(layout::RowRange rows) const {
    double bytes = 0.0;
    for (std::int64_t i = 0; i < rows.count; ++i) {
      if (is_retained(study_, (rows.first + i) % study_.trials)) bytes += trace_bytes_;
      if (bytes > static_cast<double>(max_trace_bytes_per_block)) return {rows.first, i + 1};
    }
    return rows;
  }

  const study::Study& study_;
  Turns turns_;
  TurnClock clock_;
  std::int64_t block_size_;
  double trace_bytes_;  ///< of one retained trial
};

/// Number of trials per block in a run of `rows` trials.
std::int64_t block_size_of(const study::Study& study, std::int64_t rows, int threads) {
  const BlockLimits limits = study.engine == study::Engine::batch ? batch_block : reference_block;
  const double size = limits.samples / std::max(samples_per_trial(study), 1.0);
  // Divides a short run among all threads.
  const std::int64_t rows_per_block = std::max<std::int64_t>(rows / (std::int64_t{4} * threads) + 1, 256);
  return std::clamp(static_cast<std::int64_t>(size), std::int64_t{1},
                    std::min(limits.trials, rows_per_block));
}

/// A block that has been run, or the end of all.
struct RunBlock {
  std::shared_ptr<KeptBlock> kept;  ///< null if it was interrupted, or at the end
  bool is_end{false};
};

/// What the writer gets: finished trials, and the shards that end with them.
template <class Shard>
struct Delivery {
  std::int64_t trials{0};
  std::vector<Shard> shards;
};

/// The stages through which trials become shards.
class ShardPipeline {
 public:
  ShardPipeline(const study::Study& study, const std::filesystem::path& directory,
                const RunSettings& settings)
      : study_(study),
        directory_(directory),
        settings_(settings),
        provenance_(layout::current_provenance()),
        runners_([this] { return TrialRunner(study_); }),
        collector_(study) {
    finished_.predictions.resize(static_cast<std::size_t>(study::point_count(study)));
  }

  /// See run_trials().
  FinishedTrials run(std::span<const layout::RowRange> ranges, int threads, const std::stop_token& stop) {
    BlockSource source(study_, Turns(ranges, study_.trials),
                       block_size_of(study_, layout::total_rows(ranges), threads), threads);
    namespace tbb = oneapi::tbb;
    using Mode = tbb::filter_mode;
    using Contents = std::shared_ptr<Delivery<ShardContents>>;
    using Encoded = std::shared_ptr<Delivery<shards::EncodedShard>>;
    using Stored = std::shared_ptr<std::vector<shards::StoredShard>>;
    bool has_ended = false;
    const auto next_block = [&](tbb::flow_control& control) -> std::optional<Block> {
      if (has_ended) {
        control.stop();
        return std::nullopt;
      }
      std::optional<Block> block = stop.stop_requested() ? std::nullopt : source.next();
      has_ended = !block;
      return block;
    };
    const auto pipeline = [&] {
      tbb::parallel_pipeline(
          2 * static_cast<std::size_t>(threads) + 2,
          tbb::make_filter<void, std::optional<Block>>(Mode::serial_in_order, next_block) &
              tbb::make_filter<std::optional<Block>, RunBlock>(
                  Mode::parallel, [&](const std::optional<Block>& block) { return run_block(block, stop); }) &
              tbb::make_filter<RunBlock, Contents>(Mode::serial_in_order,
                                                   [&](const RunBlock& block) { return collect(block); }) &
              tbb::make_filter<Contents, Encoded>(
                  Mode::parallel, [&](const Contents& contents) { return encode(*contents); }) &
              tbb::make_filter<Encoded, Stored>(Mode::serial_in_order,
                                                [&](const Encoded& encoded) { return store(*encoded); }) &
              tbb::make_filter<Stored, Stored>(Mode::parallel,
                                               [&](const Stored& stored) { return flush(stored); }) &
              tbb::make_filter<Stored, Stored>(Mode::serial_in_order,
                                               [&](const Stored& stored) { return read_back(stored); }) &
              tbb::make_filter<Stored, void>(Mode::parallel,
                                             [&](const Stored& stored) { publish(*stored); }));
    };
    tbb::task_arena(threads).execute(pipeline);
    shards::sort_by_rows(finished_.shards);
    return std::move(finished_);
  }

 private:
  /// Any thread. @param block none: the end
  RunBlock run_block(const std::optional<Block>& block, const std::stop_token& stop) {
    if (!block) return {nullptr, true};
    const timeline::TimeSpan span(settings_.timeline, "compute", timeline::Work::parallel, block->rows.count);
    try {
      auto kept = std::make_shared<KeptBlock>(reduce(study_, runners_.local().run_block(block->rows, stop)));
      kept->begins_turn = block->begins_turn;
      return {std::move(kept)};
    } catch (const trial::Interrupted&) {
      return {};  // the trials of the block are run again
    }
  }

  /// One thread at a time, in the order of the turns.
  std::shared_ptr<Delivery<ShardContents>> collect(const RunBlock& block) {
    const timeline::TimeSpan span(settings_.timeline, "collect", timeline::Work::serial);
    auto delivery = std::make_shared<Delivery<ShardContents>>();
    if (block.kept) {
      delivery->trials = block.kept->rows.count;
      const auto first_point = static_cast<std::size_t>(block.kept->rows.first / study_.trials);
      for (std::size_t i = 0; i < block.kept->predictions.size(); ++i)
        finished_.predictions[first_point + i] =
            finished_.predictions[first_point + i] + block.kept->predictions[i];
      collector_.take(std::move(*block.kept));
    }
    if (block.is_end) collector_.flush();
    delivery->shards = collector_.ended();
    return delivery;
  }

  /// Any thread.
  std::shared_ptr<Delivery<shards::EncodedShard>> encode(Delivery<ShardContents>& contents) const {
    auto delivery = std::make_shared<Delivery<shards::EncodedShard>>();
    delivery->trials = contents.trials;
    for (ShardContents& one : contents.shards) {
      const timeline::TimeSpan span(settings_.timeline, "encode", timeline::Work::parallel, one.rows.count);
      delivery->shards.push_back(encoded(study_, provenance_, std::move(one)));
    }
    return delivery;
  }

  /// The writer: one thread at a time, in the order of the turns.
  std::shared_ptr<std::vector<shards::StoredShard>> store(Delivery<shards::EncodedShard>& delivery) {
    auto stored = std::make_shared<std::vector<shards::StoredShard>>();
    for (const shards::EncodedShard& shard : delivery.shards) {
      const std::filesystem::path path = shards::shard_path(directory_, shard.rows);
      const timeline::TimeSpan span(settings_.timeline, "store", timeline::Work::serial, shard.rows.count);
      const std::lock_guard lock(library_);
      stored->push_back(shards::store_shard(path, study_, shard));
      finished_.shards.push_back({path, shard.rows});
    }
    delivery.shards.clear();
    if (settings_.finished && delivery.trials > 0) {
      const std::lock_guard lock(library_);  // a page that shows the run reads its shards
      // A thread that waits there must not begin another task meanwhile, such as one that needs the lock.
      oneapi::tbb::this_task_arena::isolate([&] { settings_.finished(delivery.trials); });
    }
    return stored;
  }

  /// Any thread.
  std::shared_ptr<std::vector<shards::StoredShard>> flush(
      const std::shared_ptr<std::vector<shards::StoredShard>>& stored) const {
    for (const shards::StoredShard& shard : *stored) {
      const timeline::TimeSpan span(settings_.timeline, "flush", timeline::Work::parallel, shard.rows.count);
      shards::flush_shard(shard);
    }
    return stored;
  }

  /// One thread at a time.
  std::shared_ptr<std::vector<shards::StoredShard>> read_back(
      const std::shared_ptr<std::vector<shards::StoredShard>>& stored) {
    for (const shards::StoredShard& shard : *stored) {
      const timeline::TimeSpan span(settings_.timeline, "read back", timeline::Work::serial,
                                    shard.rows.count);
      const std::lock_guard lock(library_);
      shards::require_stored(shard, settings_.timeline);
    }
    return stored;
  }

  /// Any thread.
  void publish(const std::vector<shards::StoredShard>& stored) const {
    for (const shards::StoredShard& shard : stored) {
      const timeline::TimeSpan span(settings_.timeline, "publish", timeline::Work::parallel);
      shards::publish_shard(shard);
    }
  }

  const study::Study& study_;
  const std::filesystem::path& directory_;
  const RunSettings& settings_;
  layout::Provenance provenance_;
  oneapi::tbb::enumerable_thread_specific<TrialRunner> runners_;
  ShardCollector collector_;
  std::mutex library_;  ///< of the files: two stages call it
  FinishedTrials finished_;
};

/// Gives the system what the threads have freed. Otherwise each keeps its share for blocks of trials that do
/// not come any more, beside the memory of what follows.
void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// Bytes of the statistics of the points that are written together, when all trials have been run.
double memory_of_statistics(const study::Study& study) {
  constexpr double all_statistics = 4e6;  // of the few points that have them all; measured
  constexpr double copies = 2.0;          // as they grow and as they are written
  const auto columns =
      measures::statistic_fields(study.features, layout::measure_table(study.features)).size();
  const double of_point = 8.0 * copies *
                          static_cast<double>(std::ssize(study.points.axes) + std::int64_t(columns) +
                                              study.rigs + 3 * study.worlds);
  return all_statistics +
         of_point * static_cast<double>(std::min(study::point_count(study), layout::chunk_elements));
}

}  // namespace

int threads_to_use(int asked) {
  return asked > 0 ? asked : oneapi::tbb::info::default_concurrency();
}

double samples_per_trial(const study::Study& study) {
  double total = 0.0;
  const std::int64_t asked =
      std::min<std::int64_t>(study::point_count(study) * study::condition_count(study), 64);
  for (std::int64_t i = 0; i < asked; ++i) {
    const trial::TrialParameters parameters =
        study::study_trial(study, i * study::point_count(study) / asked,
                           study::turns_of(study).trial_of(0, i % study::condition_count(study)))
            .parameters;
    total += static_cast<double>(trial::samples_of_trial(parameters));
  }
  return total / static_cast<double>(asked);
}

double peak_memory(const study::Study& study, double bytes_of_trial, double record_bytes, int threads) {
  constexpr double program = 40e6;        // program, libraries and statistics; measured
  constexpr double lanes = 2.5e6;         // of a thread; measured
  constexpr double bytes_of_point = 480;  // label, swept values and predictions, here and in HDF5; measured
  const int workers = threads_to_use(threads);
  const std::int64_t rows = study::trial_count(study);
  // A block is in memory as results and then as columns, and up to as many blocks wait as are run.
  const double in_work = 3.0 * workers * static_cast<double>(block_size_of(study, rows, workers));
  // A shard grows while another is encoded, column by column.
  const double waiting = 1.5 * std::min(static_cast<double>(max_trials_per_shard),
                                        static_cast<double>(max_bytes_per_shard) / bytes_of_trial);
  const double records = std::min(record_bytes, static_cast<double>(max_bytes_per_shard));
  const double block_traces = static_cast<double>(max_trace_bytes_per_block) + bytes_of_trace(study);
  const double running = bytes_of_trial * std::min(in_work + waiting, 3.0 * static_cast<double>(rows));
  return program + lanes * workers + bytes_of_point * static_cast<double>(study::point_count(study)) +
         3.0 * records + std::min(record_bytes, 4.0 * workers * block_traces) +
         std::max(running, memory_of_statistics(study));
}

FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop) {
  namespace tbb = oneapi::tbb;
  const int threads = threads_to_use(settings.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  FinishedTrials finished = ShardPipeline(study, directory, settings).run(ranges, threads, stop);
  return_freed_memory();
  return finished;
}

}  // namespace zerocount::trials

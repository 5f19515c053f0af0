#include "runners/trials/study_runner.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/measures/point_columns.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/table_io.hpp"
#include "runners/trials/shard_writer.hpp"
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
constexpr BlockLimits batch_block{1e7, 4096};

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

/// Runs the blocks of `ranges` in parallel, and gives them to `take` one at a time in this order.
void run_blocks(const study::Study& study, std::span<const layout::RowRange> ranges, int threads,
                const std::stop_token& stop, const std::function<void(KeptBlock&&)>& take) {
  namespace tbb = oneapi::tbb;
  using Product = std::shared_ptr<KeptBlock>;
  BlockSource source(study, Turns(ranges, study.trials),
                     block_size_of(study, layout::total_rows(ranges), threads), threads);
  const auto next_block = [&](tbb::flow_control& control) -> Block {
    std::optional<Block> block = stop.stop_requested() ? std::nullopt : source.next();
    if (!block) {
      control.stop();
      return {};
    }
    return *block;
  };
  tbb::enumerable_thread_specific<TrialRunner> runners([&study] { return TrialRunner(study); });
  const auto run_block = [&](Block block) -> Product {
    try {
      auto kept = std::make_shared<KeptBlock>(reduce(study, runners.local().run_block(block.rows, stop)));
      kept->begins_turn = block.begins_turn;
      return kept;
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
        tbb::make_filter<void, Block>(tbb::filter_mode::serial_in_order, next_block) &
            tbb::make_filter<Block, Product>(tbb::filter_mode::parallel, run_block) &
            tbb::make_filter<Product, void>(tbb::filter_mode::serial_in_order, take_block));
  };
  tbb::task_arena(threads).execute(pipeline);
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
  constexpr double program = 40e6;        // program, libraries, lanes and statistics; measured
  constexpr double bytes_of_point = 480;  // label, swept values and predictions, here and in HDF5; measured
  const int workers = threads_to_use(threads);
  const std::int64_t rows = study::trial_count(study);
  const double in_work = 4.0 * workers * static_cast<double>(block_size_of(study, rows, workers));
  const double waiting = std::min(static_cast<double>(max_trials_per_shard),
                                  static_cast<double>(max_bytes_per_shard) / bytes_of_trial);
  // Writing a shard copies its columns.
  const double records = std::min(record_bytes, static_cast<double>(max_bytes_per_shard));
  const double block_traces = static_cast<double>(max_trace_bytes_per_block) + bytes_of_trace(study);
  const double running = bytes_of_trial * std::min(in_work + 2.0 * waiting, 3.0 * static_cast<double>(rows));
  return program + bytes_of_point * static_cast<double>(study::point_count(study)) + 3.0 * records +
         std::min(record_bytes, 4.0 * workers * block_traces) +
         std::max(running, memory_of_statistics(study));
}

FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop) {
  namespace tbb = oneapi::tbb;
  const int threads = threads_to_use(settings.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  ShardWriter writer(study, directory);
  std::vector<theory::PointPrediction> predictions(static_cast<std::size_t>(study::point_count(study)));
  run_blocks(study, ranges, threads, stop, [&](KeptBlock&& block) {
    const std::int64_t trials = block.rows.count;
    const auto first_point = static_cast<std::size_t>(block.rows.first / study.trials);
    for (std::size_t i = 0; i < block.predictions.size(); ++i)
      predictions[first_point + i] = predictions[first_point + i] + block.predictions[i];
    writer.take(std::move(block));
    if (settings.finished) settings.finished(trials);
  });
  writer.flush();
  FinishedTrials finished{writer.written(), std::move(predictions)};
  shards::sort_by_rows(finished.shards);
  return finished;
}

}  // namespace zerocount::trials

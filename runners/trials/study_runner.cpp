#include "runners/trials/study_runner.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "analysis/basis/parallel/processors.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/table_io.hpp"
#include "runners/trials/block_source.hpp"
#include "runners/trials/shard_writer.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::trials {
namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_{Clock::now()};
};

/// The stages (compute, collect, encode, store) through which the results of trials become shard files. To be
/// made and used in the arena of the threads that run trials.
class ShardPipeline {
 public:
  ShardPipeline(const study::Study& study, const std::filesystem::path& directory,
                const RunSettings& settings)
      : study_(study),
        settings_(settings),
        runners_([this] { return TrialRunner(study_); }),
        collector_(study),
        writer_(study, directory, settings.timeline) {
    finished_.predictions.resize(static_cast<std::size_t>(study::point_count(study)));
  }

  /// Runs the trials of `ranges`, and writes them as shards, as the free function run_trials() describes.
  FinishedTrials run(std::span<const layout::RowRange> ranges, int threads, const std::stop_token& stop) {
    BlockSource source(study_, ranges, threads);
    namespace tbb = oneapi::tbb;
    using Mode = tbb::filter_mode;
    bool has_ended = false;
    const auto next_block = [&](tbb::flow_control& control) -> std::optional<Block> {
      std::optional<Block> block;
      if (!has_ended && !stop.stop_requested()) block = source.next();
      has_ended = !block;
      if (has_ended) control.stop();
      return block;
    };
    // Blocks that wait for an earlier one take memory.
    const auto max_blocks = static_cast<std::size_t>(threads + threads / 2 + 2);
    tbb::parallel_pipeline(
        max_blocks,
        tbb::make_filter<void, std::optional<Block>>(Mode::serial_in_order, next_block) &
            tbb::make_filter<std::optional<Block>, std::shared_ptr<KeptBlock>>(
                Mode::parallel,
                [&](const std::optional<Block>& block) { return run_block(source, *block, stop); }) &
            tbb::make_filter<std::shared_ptr<KeptBlock>, void>(
                Mode::serial_in_order, [&](const std::shared_ptr<KeptBlock>& block) { collect(block); }));
    collector_.flush();
    write_ended();
    finished_.shards = writer_.finish();
    if (unreported_ > 0 && settings_.finished) settings_.finished(unreported_);
    return std::move(finished_);
  }

 private:
  /// Runs one block of trials, on any thread.
  /// @returns the block, reduced to the data that the study keeps. After an interruption it has only the
  /// trials that ended; null if none did.
  std::shared_ptr<KeptBlock> run_block(BlockSource& source, const Block& block, const std::stop_token& stop) {
    const timeline::TimeSpan span(settings_.timeline, "compute", timeline::Work::parallel, block.rows.count);
    const Stopwatch stopwatch;
    TrialBlock ended = runners_.local().run_block(block.rows, stop);
    if (ended.results.empty()) return nullptr;
    source.note(std::ssize(ended.results), stopwatch.seconds());
    auto kept = std::make_shared<KeptBlock>(reduce(study_, std::move(ended)));
    kept->begins_turn = block.begins_turn;
    return kept;
  }

  /// Adds a finished block to the shards. Called by one thread at a time, in the order in which the blocks
  /// began.
  /// @param block null: no trial of the block ended
  void collect(const std::shared_ptr<KeptBlock>& block) {
    const timeline::TimeSpan span(settings_.timeline, "collect", timeline::Work::serial);
    writer_.require_working();
    if (!block) return;
    unreported_ += block->rows.count;
    const auto first_point = static_cast<std::size_t>(block->rows.first / study_.trials);
    for (std::size_t i = 0; i < block->predictions.size(); ++i)
      finished_.predictions[first_point + i] = finished_.predictions[first_point + i] + block->predictions[i];
    collector_.take(std::move(*block));
    write_ended();
    report();
  }

  void write_ended() {
    for (ShardContents& contents : collector_.ended()) writer_.write(std::move(contents));
  }

  /// Tells the listener of the run how many trials have finished since the last report.
  void report() {
    // A thread that waits there must not begin another task meanwhile.
    if (settings_.finished)
      oneapi::tbb::this_task_arena::isolate([&] { settings_.finished(std::exchange(unreported_, 0)); });
  }

  const study::Study& study_;
  const RunSettings& settings_;
  oneapi::tbb::enumerable_thread_specific<TrialRunner> runners_;
  ShardCollector collector_;
  FinishedTrials finished_;
  std::int64_t unreported_{0};  ///< Number of finished trials of which the listener was not told yet.
  /// Writes the shards. Declared last and so destroyed first, because its tasks use the other members.
  ShardWriter writer_;
};

/// Returns memory that the threads have freed to the operating system. Otherwise each thread would keep its
/// freed memory for further blocks of trials, which do not come, in addition to the memory of the next
/// stages.
void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// Memory that the statistics of a design point take for all machines, bytes. They keep of each machine
/// counts, and the distinct values of its moves, such as settling times. 0 without machines, or if sums
/// replace the trials.
double memory_of_machines(const study::Study& study) {
  constexpr double of_machine = 1270.0,
                   of_value = 470.0;  // of a machine, and of a trial with values of its own; measured
  if (study.machines == 0 || layout::has_sums(study.retention)) return 0.0;  // the forecast of sums has them
  const double values = std::min(static_cast<double>(study.trials),
                                 static_cast<double>(study.machines) * samples_per_trial(study));
  return of_machine * static_cast<double>(study.machines) + of_value * values;
}

/// Memory that the statistics of the design points take that are written together after all trials have been
/// run, bytes.
double memory_of_statistics(const study::Study& study) {
  constexpr double all_statistics = 4e6;  // of the few points that have them all; measured
  constexpr double copies = 2.0;          // as they grow and as they are written
  const auto columns =
      measures::statistic_fields(study.features, layout::measure_table(study.features)).size();
  const double of_point = 8.0 * copies *
                          static_cast<double>(std::ssize(study.points.axes) + std::int64_t(columns) +
                                              study.machines + 3 * study.worlds);
  return all_statistics +
         (of_point + memory_of_machines(study)) *
             static_cast<double>(std::min(study::point_count(study), layout::chunk_elements));
}

/// Parameters of the first trials of up to 64 design points, spread over the settings (conditions at ages).
std::vector<trial::TrialParameters> first_trials(const study::Study& study) {
  const std::int64_t settings = study.settings.total();
  const std::int64_t count = std::min<std::int64_t>(study::point_count(study) * settings, 64);
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t point = i * study::point_count(study) / count;
    const std::int64_t index = study::trial_indices(study).trial_of(0, i % settings);
    trials.push_back(study::study_trial(study, point, index).parameters);
  }
  return trials;
}

}  // namespace

int threads_to_use(int asked) {
  return asked > 0 ? asked : parallel::processors();
}

double samples_per_trial(const study::Study& study) {
  double total = 0.0;
  const std::vector<trial::TrialParameters> trials = first_trials(study);
  for (const trial::TrialParameters& trial : trials)
    total += static_cast<double>(trial::samples_of_trial(trial));
  return total / static_cast<double>(trials.size());
}

bool lanes_run_first_trials(const study::Study& study) {
  const std::vector<trial::TrialParameters> trials = first_trials(study);
  return std::all_of(trials.begin(), trials.end(), batch::runs_in_lanes);
}

double peak_memory(const study::Study& study, double bytes_of_trial, double record_bytes, int threads) {
  constexpr double program = 40e6;        // program, libraries and statistics; measured
  constexpr double lanes = 2.5e6;         // of a thread; measured
  constexpr double bytes_of_point = 480;  // label, swept values and predictions, here and in HDF5; measured
  const int workers = threads_to_use(threads);
  const std::int64_t rows = study::trial_count(study);
  // A block is in memory as results and then as columns, and up to as many blocks wait as are run.
  const double in_work = 3.0 * workers * static_cast<double>(max_block_rows(study, rows, workers));
  // A shard grows while another is encoded, column by column.
  const double waiting = 1.5 * std::min(static_cast<double>(max_trials_per_shard),
                                        static_cast<double>(max_bytes_per_shard) / bytes_of_trial);
  const double records = std::min(record_bytes, static_cast<double>(max_bytes_per_shard));
  const double running = bytes_of_trial * std::min(in_work + waiting, 3.0 * static_cast<double>(rows));
  return program + lanes * workers + bytes_of_point * static_cast<double>(study::point_count(study)) +
         3.0 * records + std::min(record_bytes, 4.0 * workers * max_block_traces(study)) +
         std::max(running, memory_of_statistics(study));
}

FinishedTrials run_trials(const study::Study& study, std::span<const layout::RowRange> ranges,
                          const std::filesystem::path& directory, const RunSettings& settings,
                          const std::stop_token& stop) {
  namespace tbb = oneapi::tbb;
  const int threads = threads_to_use(settings.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  FinishedTrials finished = tbb::task_arena(threads).execute(
      [&] { return ShardPipeline(study, directory, settings).run(ranges, threads, stop); });
  return_freed_memory();
  return finished;
}

}  // namespace zerocount::trials

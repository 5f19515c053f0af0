#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/trials/block_source.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/shard_writer.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::forecast {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_sampled_trials = 512;
constexpr double max_sampled_samples = 5e5;  // takes a tenth of a second
constexpr double max_traced_samples = 2e5;   // by the slower reference engine
/// Time limit of the sampled trials, and of those with traces, s. If no trial ends in time, an artificial
/// trial without jerks represents them.
constexpr double sampling_limit = 2.0;  // s

shards::TrialResult trial_without_jerks(const study::Study& study) {
  shards::TrialResult trial;
  trial.inputs.resize(study.columns.inputs.size());
  trial.outcome.moves.resize(static_cast<std::size_t>(study.moves));
  return trial;
}

/// Number of trials that have about this many samples together: at least 1, at most `most`.
std::int64_t trials_with(double samples, const study::Study& study, std::int64_t most) {
  return std::clamp(static_cast<std::int64_t>(samples / trials::samples_per_trial(study)), std::int64_t{1},
                    most);
}

using Rows = std::vector<std::int64_t>;

/// Numbers of trials (rows) at several places of the study, equally far apart: at each place, the rows `from`
/// to `to` − 1 counted from the first row of the place.
/// @param all number of trials of the study
Rows rows_at(std::int64_t places, std::int64_t from, std::int64_t to, std::int64_t all) {
  Rows rows;
  for (std::int64_t place = 0; place < places; ++place) {
    for (std::int64_t i = from; i < to; ++i) rows.push_back(all / places * place + i);
  }
  return rows;
}

/// Simulates the trials of these rows until the time limit. Returns the finished ones, without sample records
/// and numbered from 0.
/// @param groups groups of rows that run one after the other
std::vector<shards::TrialResult> run_in_time(const study::Study& study, std::span<const Rows> groups) {
  const trials::Effort limited = trials::Effort().limited_to({}, sampling_limit);
  trials::TrialRunner runner(study);
  std::vector<shards::TrialResult> trials;
  try {
    for (const Rows& rows : groups)
      std::ranges::move(runner.run(rows, limited.stop()), std::back_inserter(trials));
  } catch (const trial::Interrupted&) {
    if (trials.empty()) trials.push_back(trial_without_jerks(study));
  }
  std::ranges::sort(trials, {}, &shards::TrialResult::row);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].row = static_cast<std::int64_t>(i);
    trials[i].trace.clear();
  }
  return trials;
}

/// Simulates trials from several places of the study, enough together to fill the SIMD lanes.
std::vector<shards::TrialResult> sampled_trials(const study::Study& study) {
  const std::int64_t rows = study::trial_count(study);
  const std::int64_t wanted = trials_with(max_sampled_samples, study, std::min(max_sampled_trials, rows));
  const std::int64_t places = std::min<std::int64_t>(sampled_places, wanted);
  return run_in_time(study,
                     std::array{rows_at(places, 0, 1, rows), rows_at(places, 1, wanted / places, rows)});
}

/// Simulates the first trials of the middle design point. Empty if the file keeps every trial.
std::vector<shards::TrialResult> trials_of_point(const study::Study& study) {
  if (!layout::has_sums(study.retention)) return {};
  Rows rows(static_cast<std::size_t>(
      trials_with(max_sampled_samples, study, std::min(max_sampled_trials, study.trials))));
  std::iota(rows.begin(), rows.end(), study::point_count(study) / 2 * study.trials);
  return run_in_time(study, std::array{std::move(rows)});
}

/// Simulates some of the trials whose sample records (traces) the study retains, at design points spread over
/// the study. Empty if it retains none.
std::vector<shards::TrialResult> traced_trials(const study::Study& study) {
  if (study.retained_trials.empty() || !layout::has_trials(study.retention)) return {};
  const trials::Effort limited = trials::Effort().limited_to({}, sampling_limit);
  const std::int64_t points = study::point_count(study);
  const std::int64_t retained = std::ssize(study.retained_trials);
  const std::int64_t wanted =
      trials_with(max_traced_samples, study, std::min<std::int64_t>(sampled_places, points * retained));
  std::vector<shards::TrialResult> traced;
  for (std::int64_t i = 0; i < wanted; ++i) {
    const std::int64_t one = points * retained / wanted * i;
    const std::int64_t row =
        one / retained * study.trials + study.retained_trials[static_cast<std::size_t>(one % retained)];
    try {
      traced.push_back(trials::run_study_trial(study, row, limited.stop()));
    } catch (const trial::Interrupted&) {
      break;
    }
  }
  return traced;
}

/// Size of sums on the disk divided by their size in memory; measured.
constexpr double compressed_sums = 0.2;
/// Bytes that a column of a shard file takes without its values: its name and the sizes of its chunks.
constexpr double bytes_of_shard_column = 60.0;

double bytes_of_row(const layout::Table& table) {
  double bytes = 0.0;
  for (const layout::Column& column : table.columns)
    bytes += static_cast<double>(hdf5::size_of(column.element));
  return bytes;
}

/// Bytes that a trial with its jerks takes in a shard file, without sample records.
/// @param jerks mean number of jerks of a trial
double bytes_of_trial(const study::Study& study, double jerks) {
  constexpr double numbers = 3.0 * sizeof(std::int64_t);  // row, point and index
  const double of_move = bytes_of_row(layout::outcome_table(study.features)) +
                         static_cast<double>(study.features.bands.count) *
                             bytes_of_row(layout::band_table(study.features.bands));
  return numbers + 8.0 * static_cast<double>(study.columns.inputs.size()) +
         static_cast<double>(study.moves) * of_move + jerks * bytes_of_row(layout::jerk_table());
}

/// Bytes of all sample records (traces) of the study, in memory or in shard files.
double bytes_of_records(const study::Study& study) {
  const auto trials = static_cast<double>(std::ssize(study.retained_trials) * study::point_count(study));
  if (trials == 0.0) return 0.0;
  return trials * trials::samples_per_trial(study) * bytes_of_row(layout::trace_table(study.features));
}

/// Bytes that the columns of a shard file take without their values.
double bytes_of_descriptions(const study::Study& study) {
  double columns = 10.0;  // but for those of the trials
  if (layout::has_trials(study.retention)) {
    columns += static_cast<double>(study.columns.inputs.size());
    for (const layout::Table& table :
         {layout::outcome_table(study.features), layout::jerk_table(),
          study.retained_trials.empty() ? layout::Table{} : layout::trace_table(study.features)})
      columns += static_cast<double>(table.columns.size());
  }
  return bytes_of_shard_column * columns;
}

/// Mean number of values in the sums of a design point, from trials that are numbered from 0.
double numbers_of_sums(const study::Study& study, std::vector<shards::TrialResult> trials) {
  const auto points = static_cast<std::size_t>((std::ssize(trials) - 1) / study.trials + 1);
  const trials::KeptBlock block =
      trials::reduce(study, {std::move(trials), std::vector<theory::PointPrediction>(points)});
  double numbers = 0.0;
  for (const summary::SummedPoint& point : block.sums) {
    const layout::PointSums sums = point.sums();
    numbers += static_cast<double>(sums.whole.size() + sums.real.size());
  }
  return numbers / static_cast<double>(points);
}

/// Memory of the sums of a design point, bytes, if sums replace the trials.
struct SumBytes {
  double of_block{0.0};  ///< Memory of the sums of a few trials, as threads hold them, bytes.
  double of_all{0.0};    ///< Memory of the sums of all trials of the point, bytes.
};

SumBytes bytes_of_sums(const study::Study& study, const std::vector<shards::TrialResult>& all_trials) {
  if (!layout::has_sums(study.retention)) return {};
  constexpr std::size_t used = 64;  // trials, to which `growth` belongs
  constexpr double growth = 4.0;    // distinct values that more trials add; measured
  std::vector<shards::TrialResult> trials;
  for (std::size_t i = 0; i < all_trials.size(); i += std::max<std::size_t>(all_trials.size() / used, 1)) {
    trials.push_back(all_trials[i]);
    trials.back().row = std::ssize(trials) - 1;
  }
  const double all = numbers_of_sums(study, trials);
  const auto sampled = static_cast<double>(trials.size());
  double of_machines = 0.0;  // numbers of the machines that no sampled trial is on
  if (static_cast<double>(study.machines) > sampled && trials.size() > 1) {
    const std::vector<shards::TrialResult> half(trials.begin(), trials.begin() + std::ssize(trials) / 2);
    const double per_machine =
        (all - numbers_of_sums(study, half)) / (sampled - static_cast<double>(half.size()));
    of_machines = std::max(0.0, per_machine) * (static_cast<double>(study.machines) - sampled);
  }
  return {all * sizeof(double), (growth * all + of_machines) * sizeof(double)};
}

/// Estimated number of shard files of a run: one per turn (time in which the trials of one design point run),
/// or more if points are shorter than a turn.
double shards_of_run(const study::Study& study, int threads) {
  const std::int64_t points = study::point_count(study);
  const double seconds = measure_cost(study).seconds();
  double turns = 0.0;
  for (double elapsed = 0.0; elapsed < seconds; elapsed += trials::turn_seconds(elapsed, points, threads))
    ++turns;
  return turns + static_cast<double>(points) / static_cast<double>(trials::max_points_of_shard);
}

/// Proportion of trials that the results file keeps, 0 to 1, estimated from these trials.
double kept_proportion(const study::Study& study, std::span<const shards::TrialResult> trials) {
  if (!layout::has_trials(study.retention)) return 0.0;
  if (!layout::has_sums(study.retention)) return 1.0;
  const auto failed = std::count_if(trials.begin(), trials.end(), [](const shards::TrialResult& trial) {
    return !trial::succeeded(trial.outcome.moves);
  });
  return static_cast<double>(failed) / static_cast<double>(trials.size());
}

}  // namespace

StudySize measure_size(const study::Study& study, int threads) {
  constexpr double copies = 1.5;  // as sums that can be added to, as numbers, as they are written; measured
  constexpr double blocks_of_a_thread = 4.0;
  TrialSample sample{sampled_trials(study), traced_trials(study), trials_of_point(study)};
  const std::vector<shards::TrialResult>& trials = sample.trials;
  double jerks = 0.0, memory = 0.0;
  for (const shards::TrialResult& trial : trials) {
    jerks += static_cast<double>(trial.jerks.size()) / static_cast<double>(trials.size());
    memory += static_cast<double>(trials::bytes_of(trial)) / static_cast<double>(trials.size());
  }
  const auto points = static_cast<double>(study::point_count(study));
  sample.kept = kept_proportion(study, trials);
  const double kept = sample.kept * static_cast<double>(study::trial_count(study));
  const SumBytes sums = bytes_of_sums(study, trials);
  const double raw_records = bytes_of_records(study);
  StudySize size;
  size.file_bytes = file_bytes(study, sample);
  size.shard_bytes = bytes_of_descriptions(study) + kept * bytes_of_trial(study, jerks) + raw_records;
  size.memory_bytes = trials::peak_memory(study, memory, raw_records, threads);
  if (layout::has_sums(study.retention)) {
    size.shard_bytes +=
        compressed_sums * sums.of_all * (shards_of_run(study, trials::threads_to_use(threads)) + points);
    size.memory_bytes +=
        blocks_of_a_thread * std::max(threads, 1) * sums.of_block +
        copies * sums.of_all * std::min(points, static_cast<double>(trials::max_points_of_shard)) +
        0.5 * sums.of_all * points;
  }
  return size;
}

void require_room(const fs::path& output, const study::Study& study, std::int64_t missing) {
  const fs::path folder = output.has_parent_path() ? output.parent_path() : ".";
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error) return;  // free space unknown; a failed write will be reported
  const auto available = static_cast<double>(space.available);
  const StudySize size = measure_size(study);
  const double shards =
      size.shard_bytes * static_cast<double>(missing) / static_cast<double>(study::trial_count(study));
  if (shards + size.file_bytes <= available) return;
  throw Failure(
      ExitCode::machine_failed,
      fmt::format(
          "{}: the disk has {} free, and the run needs about {} there ({} of shards while it runs, {} "
          "for the results file); --force tries it all the same",
          folder.string(), bytes_text(available), bytes_text(shards + size.file_bytes), bytes_text(shards),
          bytes_text(size.file_bytes)));
}

std::string bytes_text(double bytes) {
  constexpr std::array<const char*, 5> units{"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 999.5 && unit + 1 < units.size()) {
    bytes /= 1000.0;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", bytes, bytes < 9.95 && unit > 0 ? 1 : 0, units[unit]);
}

}  // namespace zerocount::forecast

#include "runners/study_run/study_size.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/info.h>

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/layout.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/study_run/cost.hpp"
#include "runners/study_run/deadline.hpp"
#include "runners/study_run/study_runner.hpp"
#include "runners/study_run/sums_writer.hpp"
#include "runners/study_run/temporary_folder.hpp"
#include "runners/study_run/trial_runner.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_sampled_trials = 512;
constexpr double max_sampled_samples = 4e5;  // takes some hundredths of a second
/// Ratio of the memory or uncompressed storage of a trial to its values: chunks, and copies of columns.
constexpr double storage_factor = 2.0;
constexpr std::int64_t sampled_places = 8;

/// For the sampled trials, and for those with traces. Where none ends in time, a trial without jerks stands
/// for them.
constexpr std::chrono::seconds sampling_limit{2};

shards::TrialResult trial_without_jerks(const study::Study& study) {
  shards::TrialResult trial;
  trial.inputs.resize(study.input_columns.size());
  trial.outcome.moves.resize(static_cast<std::size_t>(study.moves));
  return trial;
}

/// Trials from several places of the study, numbered from 0.
std::vector<shards::TrialResult> sampled_trials(const study::Study& study) {
  const Deadline deadline(sampling_limit);
  const std::int64_t rows = study::trial_count(study);
  const auto wanted = std::clamp(static_cast<std::int64_t>(max_sampled_samples / samples_per_trial(study)),
                                 std::int64_t{1}, std::min(max_sampled_trials, rows));
  const std::int64_t places = std::min(sampled_places, wanted);
  TrialRunner runner(study);
  std::vector<shards::TrialResult> trials;
  try {
    for (std::int64_t place = 0; place < places; ++place) {
      const std::int64_t first = rows / places * place;
      std::vector<shards::TrialResult> here = runner.run({first, wanted / places}, deadline.token());
      trials.insert(trials.end(), std::make_move_iterator(here.begin()), std::make_move_iterator(here.end()));
    }
  } catch (const trial::Interrupted&) {
    if (trials.empty()) trials.push_back(trial_without_jerks(study));
  }
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i].row = static_cast<std::int64_t>(i);
  return trials;
}

/// Mean of bytes_of().
double mean_bytes(std::span<const shards::TrialResult> trials) {
  double bytes = 0.0;
  for (const shards::TrialResult& trial : trials)
    bytes += static_cast<double>(bytes_of(trial)) / static_cast<double>(trials.size());
  return bytes;
}

/// Bytes of a shard of these trials.
double shard_size(const TemporaryFolder& folder, const study::Study& study,
                  std::span<const shards::TrialResult> trials, hdf5::Compression compression) {
  const fs::path path = folder.path() / "sample.h5";
  shards::write_shard(path, study, 0, trials, layout::current_provenance(), compression);
  return static_cast<double>(fs::file_size(path));
}

/// Size as a linear function of the number of trials, bytes.
struct Growth {
  double fixed{0.0};
  double per_trial{0.0};
};

Growth growth_of(const TemporaryFolder& folder, const study::Study& study,
                 std::span<const shards::TrialResult> trials, hdf5::Compression compression) {
  const double all = shard_size(folder, study, trials, compression);
  if (trials.size() < 2) return {0.0, all};
  const double one = shard_size(folder, study, trials.first(1), compression);
  const double per_trial = (all - one) / static_cast<double>(trials.size() - 1);
  return {one - per_trial, per_trial};
}

/// Up to eight trials with their traces, numbered from 0.
std::vector<shards::TrialResult> sampled_records(const study::Study& study) {
  constexpr std::int64_t max_records = 8;
  const auto retained = std::ssize(study.retained_trials);
  const Deadline deadline(sampling_limit);
  std::vector<shards::TrialResult> trials;
  for (std::int64_t i = 0; i < std::min(retained, max_records); ++i) {
    try {
      trials.push_back(
          run_study_trial(study, study.retained_trials[static_cast<std::size_t>(i)], deadline.token()));
    } catch (const trial::Interrupted&) {
      break;
    }
    trials.back().row = i;
  }
  return trials;
}

/// Bytes of the traces of all retained trials, without the fixed size of a table.
double record_bytes(const TemporaryFolder& folder, const study::Study& study,
                    std::vector<shards::TrialResult> sampled, hdf5::Compression compression) {
  if (sampled.empty()) return 0.0;
  const double with = shard_size(folder, study, sampled, compression);
  const auto count = static_cast<double>(sampled.size());
  for (std::size_t i = sampled.size() > 1 ? 1 : 0; i < sampled.size(); ++i) sampled[i].trace.clear();
  const double without = shard_size(folder, study, sampled, compression);
  const double per_record = (with - without) / (count > 1.0 ? count - 1.0 : 1.0);
  return per_record * static_cast<double>(std::ssize(study.retained_trials) * study::point_count(study));
}

/// Bytes of the results file without its trials.
double table_bytes(const study::Study& study) {
  constexpr double statistics = 400e3;  // some hundred columns with their descriptions, measured
  constexpr double statistics_of_point = 1600.0;
  double profiles = 0.0;
  for (const study::RealisedProfile& profile : study.profiles) {
    const std::int64_t values = profile.of_rig ? study.rigs * layout::profile_angles_of_rig(
                                                                  profile.profile->cosine.size(), study.rigs)
                                               : layout::profile_angles;
    profiles += 8.0 * static_cast<double>(values);
  }
  return statistics + statistics_of_point * static_cast<double>(study::point_count(study)) + profiles;
}

/// An upper bound of the size of a study's files, computed without writing any.
double file_bytes_at_most(const study::Study& study) {
  const double records = static_cast<double>(std::ssize(study.retained_trials) * study::point_count(study)) *
                         samples_per_trial(study) * static_cast<double>(sizeof(trial::SampleRecord));
  const double once = mean_bytes(sampled_trials(study)) * static_cast<double>(study::trial_count(study)) +
                      records + table_bytes(study);
  return 2.0 * storage_factor * once;  // the shards, and the results file
}

/// Nothing if the folder for temporary files has no room.
std::optional<StudySize> measured_size(const study::Study& study) {
  try {
    return measure_size(study);
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::machine_failed) throw;
    return std::nullopt;
  }
}

/// Numbers in the sums of a point, of trials that are numbered from 0.
double numbers_of_sums(const study::Study& study, std::vector<shards::TrialResult> trials) {
  const auto points = static_cast<std::size_t>((std::ssize(trials) - 1) / study.trials + 1);
  const SummedBlock block =
      sum_block(study, {std::move(trials), std::vector<theory::PointPrediction>(points)});
  double numbers = 0.0;
  for (const summary::SummedPoint& point : block.points) {
    const layout::PointSums sums = point.sums();
    numbers += static_cast<double>(sums.whole.size() + sums.real.size());
  }
  return numbers / static_cast<double>(points);
}

/// Bytes of the sums of a point in memory.
struct SumBytes {
  double of_block{0.0};  ///< of few trials, as threads hold them
  double of_all{0.0};
};

SumBytes bytes_of_sums(const study::Study& study, const std::vector<shards::TrialResult>& trials) {
  constexpr double growth = 4.0;  // distinct values that more trials add; measured
  const double all = numbers_of_sums(study, trials);
  const auto sampled = static_cast<double>(trials.size());
  double of_rigs = 0.0;  // numbers of the rigs that no sampled trial is on
  if (static_cast<double>(study.rigs) > sampled && trials.size() > 1) {
    const std::vector<shards::TrialResult> half(trials.begin(), trials.begin() + std::ssize(trials) / 2);
    const double per_rig =
        (all - numbers_of_sums(study, half)) / (sampled - static_cast<double>(half.size()));
    of_rigs = std::max(0.0, per_rig) * (static_cast<double>(study.rigs) - sampled);
  }
  return {all * sizeof(double), growth * (all + of_rigs) * sizeof(double)};
}

/// Shards of a run: one each 20 s, and more at its beginning.
double shards_of_run(const study::Study& study) {
  constexpr double at_the_beginning = 40.0, interval = 20.0;
  return at_the_beginning + measure_cost(study).seconds() / interval +
         static_cast<double>(study::point_count(study)) / max_points_of_shard;
}

/// The size of a study that keeps statistics, and perhaps failures.
StudySize measure_summed_size(const TemporaryFolder& folder, const study::Study& study, int threads) {
  constexpr double compressed = 0.2;  // of the bytes in memory; measured
  constexpr double copies = 3.0;      // as sums that can be added to, as numbers, as they are written
  constexpr double blocks_of_a_thread = 4.0;
  const std::vector<shards::TrialResult> trials = sampled_trials(study);
  const auto failed = std::count_if(trials.begin(), trials.end(), [](const shards::TrialResult& trial) {
    return !trial::succeeded(trial.outcome.moves);
  });
  const double kept = study.kept == study::Kept::failures
                          ? static_cast<double>(failed) / static_cast<double>(trials.size()) *
                                static_cast<double>(study::trial_count(study))
                          : 0.0;
  const SumBytes bytes = bytes_of_sums(study, trials);
  const double sums = bytes.of_all;
  const auto points = static_cast<double>(study::point_count(study));
  StudySize size;
  size.file_bytes = table_bytes(study) + compressed * sums * points +
                    kept * growth_of(folder, study, trials, hdf5::Compression::deflate).per_trial;
  size.shard_bytes = compressed * sums * (shards_of_run(study) + points) +
                     kept * growth_of(folder, study, trials, hdf5::Compression::none).per_trial;
  size.memory_bytes = peak_memory(study, mean_bytes(trials), 0.0, threads) +
                      blocks_of_a_thread * std::max(threads, 1) * bytes.of_block +
                      copies * sums * std::min(points, double{max_points_of_shard}) + 2.0 * sums * points;
  return size;
}

}  // namespace

StudySize measure_size(const study::Study& study, int threads) {
  const TemporaryFolder folder;
  if (study.kept != study::Kept::trials) return measure_summed_size(folder, study, threads);
  std::vector<shards::TrialResult> trials = sampled_trials(study);
  for (shards::TrialResult& trial : trials) trial.trace.clear();
  const Growth file = growth_of(folder, study, trials, hdf5::Compression::deflate);
  const Growth shards = growth_of(folder, study, trials, hdf5::Compression::none);
  const auto rows = static_cast<double>(study::trial_count(study));
  const std::vector<shards::TrialResult> records = sampled_records(study);
  const double raw_records = record_bytes(folder, study, records, hdf5::Compression::none);
  StudySize size;
  size.file_bytes = file.fixed + file.per_trial * rows + table_bytes(study) +
                    record_bytes(folder, study, records, hdf5::Compression::deflate);
  size.shard_bytes = shards.fixed + shards.per_trial * rows + raw_records;
  size.memory_bytes = peak_memory(study, mean_bytes(trials), raw_records, threads);
  return size;
}

void require_room(const fs::path& output, const study::Study& study, std::int64_t missing) {
  const fs::path folder = output.has_parent_path() ? output.parent_path() : ".";
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (error) return;  // free space unknown; a failed write will be reported
  const auto available = static_cast<double>(space.available);
  if (study.kept == study::Kept::trials && file_bytes_at_most(study) < available) return;
  const std::optional<StudySize> size = measured_size(study);
  if (!size) return;
  const double shards =
      size->shard_bytes * static_cast<double>(missing) / static_cast<double>(study::trial_count(study));
  if (shards + size->file_bytes <= available) return;
  throw Failure(
      ExitCode::machine_failed,
      fmt::format(
          "{}: the disk has {} free, and the run needs about {} there ({} of shards while it runs, {} "
          "for the results file); --force tries it all the same",
          folder.string(), bytes_text(available), bytes_text(shards + size->file_bytes), bytes_text(shards),
          bytes_text(size->file_bytes)));
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

}  // namespace zerocount::study_run

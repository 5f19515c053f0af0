#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"
#include "results/shards/trial_columns.hpp"

namespace zerocount::forecast {

/// Computing time of a study, estimated from the time of some of its trials.
struct StudyCost {
  double samples{0.0};  ///< Number of controller samples of all trials of the study together.
  /// Computing time per controller sample on one core, measured on trials of the study, s.
  double seconds_per_sample{0.0};
  int cores{1};  ///< Number of cores of this computer.

  /// Time that the study takes with all cores of this computer, s.
  double seconds() const { return samples * seconds_per_sample / cores; }
};

/// Measures how long a sample takes with the batch engine, on trials spread over the study. Takes about a
/// twentieth of a second. Trials are cut at 200 000 samples, or earlier if these would take longer.
StudyCost measure_cost(const study::Study& study);

/// Design points of a study whose trials the batch engine passes to the reference engine, which is several
/// times slower, because its SIMD lanes lack a feature.
struct PointsOnReference {
  std::int64_t points{0};    ///< Number of examined design points that run on the reference engine.
  std::int64_t examined{0};  ///< Number of examined design points: the first of the study, at most 1000.
  /// Features of these points that the SIMD lanes lack (batch::lacking_in_lanes), without repeats.
  std::vector<std::string> features;
};

/// Counts the design points that run on the reference engine, by the first trial of each point. If the user
/// asked for the reference engine, no point is counted.
PointsOnReference points_on_reference(const study::Study& study);

/// Text such as "2 of 6 points run on the reference engine, several times slower, because of
/// disturbance.ripple without friction". Empty if no point runs on the reference engine.
std::string engine_text(const PointsOnReference& use);

/// Simulated sample of the trials of a study, from which sizes are estimated.
struct TrialSample {
  /// Trials from several places of the study, numbered from 0, without sample records (traces).
  std::vector<shards::TrialResult> trials;
  /// Trials with sample records (traces); empty if the study retains none.
  std::vector<shards::TrialResult> traced;
  /// Trials of one design point, numbered from 0. Empty if the file keeps every trial.
  std::vector<shards::TrialResult> of_point;
  double kept{1.0};  ///< Proportion of all trials that the file keeps, 0 to 1.
};

/// Estimated size of the study's results file, bytes.
double file_bytes(const study::Study& study, const TrialSample& sample);

/// Number of places, equally far apart in a study or in a column, from which samples are taken.
inline constexpr std::size_t sampled_places = 8;

/// Size that the elements of a column have in a results file after compression, bytes.
double stored_bytes(hdf5::Element element, std::span<const std::byte> values);

/// Sample of a column's elements in their order: equally many contiguous elements from each of
/// `sampled_places` places of the column.
struct ColumnSample {
  hdf5::Element element;
  std::span<const std::byte> values;
  /// Number of elements per design point; 0: none. A value may equal the one a period before.
  double period{0.0};
};

/// Estimate of stored_bytes() for `count` elements of which a sample is known.
///
/// A chunk of similar elements is generated and filtered, by a smoothed bootstrap: frequent values are drawn
/// as they are, any other value represents the interval to the next one. Elements keep their place, so the
/// beginning of the sample represents the beginning of the column. The proportion of values equal to the
/// value one period before is that of the sample.
/// @param twin_of returns the first element that equals element i in every study, such as the one of the same
/// machine; empty: no element has a twin
double stored_bytes(const ColumnSample& sample, double count,
                    const std::function<std::int64_t(std::int64_t)>& twin_of = {});

/// Memory and disk space of a study, estimated from some of its trials.
struct StudySize {
  double file_bytes{0.0};  ///< Size of the study's results file, bytes.
  /// Size of the shards (temporary files with the trials) of all trials, bytes. They exist until the results
  /// file is complete.
  double shard_bytes{0.0};
  double memory_bytes{0.0};  ///< Peak memory of a run, bytes.
};

/// Forecasts the sizes of a study's files and its memory from the columns of its tables. Up to 512 trials
/// spread over the study (at most about 500 000 samples) show how many jerks and failures there are, how long
/// the sums are, and how well values are compressed. For a study with `stop`, the forecast assumes the
/// maximum number of trials.
/// @param threads number of threads of the run; 0: all cores
StudySize measure_size(const study::Study& study, int threads = 0);

/// Checks before a run that the disk has enough free space.
/// @param missing number of trials that are still to run
/// @throws Failure (machine_failed) if the folder of `output` has no room for the results file and the shards
/// (temporary files) of the missing trials
void require_room(const std::filesystem::path& output, const study::Study& study, std::int64_t missing);

/// Text of a size with two significant digits, such as "44 MB".
std::string bytes_text(double bytes);

}  // namespace zerocount::forecast

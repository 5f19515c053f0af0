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

/// Computing time of a study.
struct StudyCost {
  double samples{0.0};             ///< Number of samples of all trials together.
  double seconds_per_sample{0.0};  ///< Time per sample on one core, measured on trials of the study, s.
  int cores{1};                    ///< Number of cores of this computer.

  /// Time of the study with all cores, s.
  double seconds() const { return samples * seconds_per_sample / cores; }
};

/// Measures the cost of the batch engine on trials spread over the study, for about a twentieth of a second.
/// Trials are cut at 200 000 samples, or earlier if these would take longer.
StudyCost measure_cost(const study::Study& study);

/// Design points of a study whose trials the batch engine passes to the reference engine, which is several
/// times slower.
struct PointsOnReference {
  std::int64_t points{0};    ///< Number of examined points that run on the reference engine.
  std::int64_t examined{0};  ///< Number of examined points: the first of the study, at most 1000.
  /// Features that the lanes lack (batch::lacking_in_lanes), without repeats.
  std::vector<std::string> features;
};

/// Counts the points on the reference engine by the first trial of each point. If the user asked for the
/// reference engine, no point is counted.
PointsOnReference points_on_reference(const study::Study& study);

/// Text such as "2 of 6 points run on the reference engine, several times slower, because of
/// disturbance.ripple without friction". Empty if no point runs on the reference engine.
std::string engine_text(const PointsOnReference& use);

/// Sample of the trials of a study, from which sizes are estimated.
struct TrialSample {
  /// Trials from several places of the study, numbered from 0, without records.
  std::vector<shards::TrialResult> trials;
  std::vector<shards::TrialResult> traced;  ///< Trials with records; empty if the study retains none.
  /// Trials of one design point, numbered from 0. Empty if every trial is kept.
  std::vector<shards::TrialResult> of_point;
  double kept{1.0};  ///< Proportion of trials that the file keeps.
};

/// Estimate of the size of the results file, bytes.
double file_bytes(const study::Study& study, const TrialSample& sample);

/// Number of places of a study, or of a column, from which samples are taken.
inline constexpr std::size_t sampled_places = 8;

/// Size that these elements of a column have in a results file after its filters, bytes.
double stored_bytes(hdf5::Element element, std::span<const std::byte> values);

/// Sample of a column's elements in their order: equally many contiguous elements from each of
/// `sampled_places` places.
struct ColumnSample {
  hdf5::Element element;
  std::span<const std::byte> values;
  double period{0.0};  ///< Elements per design point. A value may equal the one a period before.
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
  double file_bytes{0.0};  ///< Size of the results file, bytes.
  /// Size of the shards of all trials, bytes. They exist until the file is complete.
  double shard_bytes{0.0};
  double memory_bytes{0.0};  ///< Peak memory, bytes.
};

/// Forecasts the sizes of a study from the columns of its tables. Up to 512 trials spread over the study (at
/// most about 500 000 samples) show how many jerks and failures there are, how long the sums are, and how
/// well values are compressed. For a study with `stop`, the forecast assumes the maximum number of trials.
/// @param threads number of threads of the run; 0: all cores
StudySize measure_size(const study::Study& study, int threads = 0);

/// Checks the free disk space before a run.
/// @param missing number of trials that are still to run
/// @throws Failure (machine_failed) if the folder of `output` has no room for the results file and the shards
/// of the missing trials
void require_room(const std::filesystem::path& output, const study::Study& study, std::int64_t missing);

/// Text of a size with two significant digits, such as "44 MB".
std::string bytes_text(double bytes);

}  // namespace zerocount::forecast

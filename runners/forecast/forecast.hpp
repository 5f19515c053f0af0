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
  double samples{0.0};             ///< of all trials together
  double seconds_per_sample{0.0};  ///< of one core, measured on trials of the study
  int cores{1};                    ///< of this machine

  double seconds() const { return samples * seconds_per_sample / cores; }  ///< with all cores
};

/// Measures the cost of the batch engine on trials spread over the study, for about a twentieth of a second.
/// Trials are cut at 200 000 samples, or less if those would take longer.
StudyCost measure_cost(const study::Study& study);

/// Design points of a study whose trials the batch engine passes to the reference engine, which is several
/// times slower.
struct PointsOnReference {
  std::int64_t points{0};             ///< of those examined
  std::int64_t examined{0};           ///< the first points of the study, 1000 at most
  std::vector<std::string> features;  ///< that the lanes lack (batch::lacking_in_lanes), each once
};

/// Examines the first trial of each point. None are counted if the user asked for the reference engine.
PointsOnReference points_on_reference(const study::Study& study);

/// E.g. "2 of 6 points run on the reference engine, several times slower, because of disturbance.ripple
/// without friction".
/// Empty if no point does.
std::string engine_text(const PointsOnReference& use);

/// Some trials of a study, from which its sizes are estimated.
struct TrialSample {
  std::vector<shards::TrialResult> trials;  ///< of several places, numbered from 0, without records
  std::vector<shards::TrialResult> traced;  ///< with records; empty where the study retains none
  /// Of one design point, numbered from 0; empty where every trial is kept.
  std::vector<shards::TrialResult> of_point;
  double kept{1.0};  ///< proportion of trials that the file keeps
};

/// Bytes of the results file.
double file_bytes(const study::Study& study, const TrialSample& sample);

inline constexpr std::size_t sampled_places = 8;

/// Bytes that a results file stores for these elements of a column, after its filters.
double stored_bytes(hdf5::Element element, std::span<const std::byte> values);

/// Some elements of a column in their order: from `sampled_places` of it, as many that follow one another.
struct ColumnSample {
  hdf5::Element element;
  std::span<const std::byte> values;
  double period{0.0};  ///< elements to the same trial of the next design point, whose value may be equal
};

/// Estimate of stored_bytes() of `count` elements, of which some are known. A chunk of elements like them is
/// made up and filtered: a value that occurs often is drawn again, another stands for those between it and
/// the next (a smoothed bootstrap). They keep their place: the sample's beginning stands for the beginning of
/// the column. As many as in the sample equal the value one period before.
/// @param twin_of the first element that equals element i in every study, such as that of the same machine;
/// empty: none does
double stored_bytes(const ColumnSample& sample, double count,
                    const std::function<std::int64_t(std::int64_t)>& twin_of = {});

/// Memory and disk space of a study, estimated from some of its trials.
struct StudySize {
  double file_bytes{0.0};    ///< of the results file
  double shard_bytes{0.0};   ///< of the shards of all trials, which exist until the file is complete
  double memory_bytes{0.0};  ///< peak
};

/// Forecasts the sizes from the columns of the tables. Up to 512 trials spread over the study (about 500
/// 000 samples at most) tell how many jerks and failures there are, how long sums are, and how well the
/// values are compressed. For a study with `stop`: the maximum number of trials.
/// @param threads of the run; 0: all cores
StudySize measure_size(const study::Study& study, int threads = 0);

/// @throws Failure (machine_failed) if the folder of `output` has no room for the results file and the shards
/// of the `missing` trials.
void require_room(const std::filesystem::path& output, const study::Study& study, std::int64_t missing);

/// "44 MB", to two significant digits.
std::string bytes_text(double bytes);

}  // namespace zerocount::forecast

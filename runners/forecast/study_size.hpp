#pragma once

#include <filesystem>

#include "experiments/study/study_fwd.hpp"

namespace zerocount::forecast {

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

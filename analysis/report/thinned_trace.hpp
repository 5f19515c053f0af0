#pragma once

#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"
#include "results/shards/shard.hpp"

namespace zerocount {

/// A trial that was run again, and what of its samples a figure needs.
struct ReplayedTrial {
  std::int64_t point{0};
  TrialResult result;                 ///< to be compared with what is recorded
  std::vector<SampleRecord> samples;  ///< thinned
};

/// Thins the samples of a trial while it runs, so that a line through what is left looks the same.
///
/// The samples are put into at most `buckets` groups of equal length, and of each the first, the last, and
/// those with the least and the greatest error and torque are kept: no jerk of one sample is lost. Of samples
/// that do not differ in count, torque and target from those on both sides none is kept. (Jugel et al. 2014,
/// M4.)
class TraceThinner {
 public:
  TraceThinner(std::int64_t samples, std::int64_t buckets);
  void add(const SampleRecord& sample);
  /// What is left of those added, in order.
  std::vector<SampleRecord> finish();

 private:
  void close_bucket();

  std::int64_t bucket_length_;
  std::int64_t bucket_{0};
  std::vector<SampleRecord> at_hand_;
  std::vector<SampleRecord> kept_;
};

/// Runs a trial of the study again by the plain engine. The row of the result is left to who knows the file.
ReplayedTrial replay_trial(const Study& study, std::int64_t point, std::int64_t index, std::int64_t buckets);

}  // namespace zerocount

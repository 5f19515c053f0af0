#pragma once

#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::report {

/// A trial that was simulated again, with the samples for a figure.
struct ReplayedTrial {
  std::int64_t point{0};
  trial::TrialParameters parameters;
  shards::TrialResult result;                ///< to compare with the record
  std::vector<trial::SampleRecord> samples;  ///< thinned
};

/// Reduces the samples of a trial while it runs, so that a line through the kept samples looks the same.
/// The samples are divided into at most `buckets` groups of equal length. Of each group the first, the last,
/// and those with the minimum and maximum error and torque are kept, so that a jerk of one sample remains
/// visible. Samples with the same count, torque and target as both neighbours are dropped. (Jugel et al.
/// 2014, M4.)
class TraceThinner {
 public:
  TraceThinner(std::int64_t samples, std::int64_t buckets);
  void add(const trial::SampleRecord& sample);
  /// The kept samples, in order.
  std::vector<trial::SampleRecord> finish();

 private:
  void close_bucket();

  std::int64_t bucket_length_;
  std::int64_t bucket_{0};
  std::vector<trial::SampleRecord> at_hand_;
  std::vector<trial::SampleRecord> kept_;
};

/// Simulates a trial of the study again with the reference engine. The caller sets the row of the result.
ReplayedTrial replay_trial(const study::Study& study, std::int64_t point, std::int64_t index,
                           std::int64_t buckets);

}  // namespace zerocount::report

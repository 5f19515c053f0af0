#include "analysis/report/figures/thinned_trace.hpp"

#include <algorithm>
#include <cstddef>

#include "analysis/report/figures/thinning.hpp"

namespace zerocount::report {
namespace {

bool alike(const trial::SampleRecord& a, const trial::SampleRecord& b) {
  return a.count == b.count && a.torque == b.torque && a.target == b.target;
}

}  // namespace

TraceThinner::TraceThinner(std::int64_t samples, std::int64_t buckets)
    : bucket_length_(std::max<std::int64_t>(1, (samples + buckets - 1) / buckets)) {}

void TraceThinner::add(const trial::SampleRecord& sample) {
  if (sample.k / bucket_length_ != bucket_) {
    close_bucket();
    bucket_ = sample.k / bucket_length_;
  }
  at_hand_.push_back(sample);
}

void TraceThinner::close_bucket() {
  const std::vector<SampleQuantity> quantities{
      [&](std::size_t i) { return static_cast<double>(at_hand_[i].error); },
      [&](std::size_t i) { return at_hand_[i].torque; }};
  for (const std::size_t place : extreme_samples(0, at_hand_.size(), quantities)) {
    const trial::SampleRecord& sample = at_hand_[place];
    const std::size_t size = kept_.size();
    if (size >= 2 && alike(kept_[size - 1], sample) && alike(kept_[size - 2], sample)) kept_.pop_back();
    kept_.push_back(sample);
  }
  at_hand_.clear();
}

std::vector<trial::SampleRecord> TraceThinner::finish() {
  close_bucket();
  return std::move(kept_);
}

ReplayedTrial replay_trial(const study::Study& study, std::int64_t point, std::int64_t index,
                           std::int64_t buckets) {
  const study::StudyTrial trial = study::study_trial(study, point, index);
  TraceThinner thinner(trial::samples_of_trial(trial.parameters), buckets);
  ReplayedTrial replayed;
  replayed.point = point;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) { thinner.add(sample); };
  observers.jerk = [&](const trial::Jerk& jerk) { replayed.result.jerks.push_back(jerk); };
  replayed.result.inputs = trial.inputs;
  replayed.result.outcome = trial::run_trial(trial.parameters, observers);
  replayed.samples = thinner.finish();
  replayed.parameters = trial.parameters;
  return replayed;
}

}  // namespace zerocount::report

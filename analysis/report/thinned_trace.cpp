#include "analysis/report/thinned_trace.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

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
  if (at_hand_.empty()) return;
  const auto by_error = [](const trial::SampleRecord& a, const trial::SampleRecord& b) {
    return a.error < b.error;
  };
  const auto by_torque = [](const trial::SampleRecord& a, const trial::SampleRecord& b) {
    return a.torque < b.torque;
  };
  const auto errors = std::minmax_element(at_hand_.begin(), at_hand_.end(), by_error);
  const auto torques = std::minmax_element(at_hand_.begin(), at_hand_.end(), by_torque);
  std::array<std::ptrdiff_t, 6> places{0,
                                       errors.first - at_hand_.begin(),
                                       errors.second - at_hand_.begin(),
                                       torques.first - at_hand_.begin(),
                                       torques.second - at_hand_.begin(),
                                       std::ssize(at_hand_) - 1};
  std::sort(places.begin(), places.end());
  const auto end = std::unique(places.begin(), places.end());
  for (auto place = places.begin(); place != end; ++place) {
    const trial::SampleRecord& sample = at_hand_[static_cast<std::size_t>(*place)];
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
  return replayed;
}

}  // namespace zerocount::report

// Assigns trials to lanes, and collects their outcomes.
#include "core/batch/lane_scheduler.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <utility>

#include "core/batch/lane_rest.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::batch {

LaneScheduler::LaneScheduler(const BatchSettings& settings)
    : kernels_(kernels_of(settings.instructions)),
      lane_count_(std::clamp(settings.lanes, 1, max_lanes)),
      trials_in_work_(static_cast<std::size_t>(lane_count_)) {
  fill_spare_lane();
}

void LaneScheduler::fill_spare_lane() {
  // Any finite state will do: a trial with default parameters.
  trial::TrialParameters parameters;
  parameters.command.targets = {0};
  LaneTrial spare;
  trial::TrialOutcome outcome;
  start_trial(batch_, spare_lane, spare, 0, parameters, outcome);
  batch_.time.time_to_stop[spare_lane] = batch_.time.sample_time[spare_lane];
}

void LaneScheduler::run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
                        const BatchObservers& observers) {
  source_ = &source;
  outcomes_ = outcomes;
  observers_ = &observers;
  next_trial_ = 0;
  batch_.passed = observers.sample ? passed_ : nullptr;
  // Equal trials in equal lanes then need no new memory in the next run.
  std::iota(trial_index_, trial_index_ + lane_count_, std::size_t{0});
  for (int lane = 0; lane < lane_count_; ++lane) refill(lane);
  used_lanes_ = lane_count_;
  while (!active_.empty()) {
    if (observers.stop.stop_requested()) throw trial::Interrupted{};
    close_gaps();
    take_samples();
    move_sticking();
    move_sliding();
    move_bristles();
    move_free();
  }
}

/// Gives the lane the next trial that lanes can run, if any. Runs those before it by run_trial.
void LaneScheduler::refill(int lane) {
  LaneTrial& trial = trial_of(lane);
  for (LaneSet* of : sets()) of->erase(lane);
  while (next_trial_ < outcomes_.size()) {
    const std::size_t number = next_trial_++;
    const trial::TrialParameters& parameters = (*source_)(number, trial_index_[lane]);
    trial.parameters = &parameters;
    trial.number = number;
    trial.outcome = &outcomes_[number];
    if (runs_in_lanes(parameters)) {
      outcomes_[number].moves.clear();
      outcomes_[number].moves.reserve(parameters.command.targets.size());
      start_trial(batch_, lane, trial, number, parameters, outcomes_[number]);
      active_.insert(lane);
      if (trial.loop) {
        with_loop_.insert(lane);
      } else if (has_blocks(parameters)) {
        with_blocks_.insert(lane);
      }
      set_moving(lane);
      if (trial.drive && trial.drive->jitters()) begin_piece(lane, trial);
      return;
    }
    run_scalar(trial, 0, 0);
  }
}

/// Inserts the lane, which has a trial, into the set of its kind of motion.
void LaneScheduler::set_moving(int lane) {
  switch (trial_of(lane).motion) {
    case LaneMotion::contact:
      break;
    case LaneMotion::bristle:
      bristles_.insert(lane);
      return;
    case LaneMotion::free:
      free_.insert(lane);
      return;
  }
  const bool slides = batch_.motion.slide_direction[lane] != 0.0;
  waiting_.erase(lane);
  (slides ? sticking_ : sliding_).erase(lane);
  (slides ? sliding_ : sticking_).insert(lane);
}

/// Moves trials from the last lanes to idle ones, once no trials are left to fill those. Kernels are faster
/// on neighbouring lanes, which share cache lines.
void LaneScheduler::close_gaps() {
  const int running = active_.count();
  if (running == used_lanes_ || next_trial_ < outcomes_.size()) return;
  int gap = 0;
  for (; used_lanes_ > running; --used_lanes_) {
    const int last = used_lanes_ - 1;
    if (is_idle(last)) continue;
    while (!is_idle(gap)) ++gap;
    move_lane(last, gap);
  }
}

namespace {

/// Copies each quantity of one lane to another. Numbers is a struct of Lanes alone.
template <class Numbers>
void copy_lane(Numbers& numbers, int from, int to) {
  constexpr std::size_t quantities = sizeof(Numbers) / sizeof(Lanes);
  static_assert(quantities * sizeof(Lanes) == sizeof(Numbers));
  auto* const bytes = reinterpret_cast<std::byte*>(&numbers);
  for (std::size_t i = 0; i < quantities; ++i) {
    std::byte* const lanes = bytes + i * sizeof(Lanes);
    std::memcpy(lanes + to * sizeof(double), lanes + from * sizeof(double), sizeof(double));
  }
}

}  // namespace

void LaneScheduler::move_lane(int from, int to) {
  copy_lane(static_cast<LaneNumbers&>(batch_), from, to);
  if (with_blocks_.contains(from)) copy_lane(batch_.blocks, from, to);
  if (batch_.loop.driven[from] != 0.0) copy_lane(batch_.course, from, to);
  std::swap(trial_index_[to], trial_index_[from]);
  for (LaneSet* of : sets()) {
    if (of->contains(from)) of->insert(to);
    of->erase(from);
  }
}

/// Runs the whole trial by run_trial. Jerks and samples already reported are not reported again.
void LaneScheduler::run_scalar(const LaneTrial& trial, std::int64_t reported_jerks,
                               std::int64_t reported_samples) {
  trial::TrialObservers single;
  single.stop = observers_->stop;
  std::int64_t jerks = 0;
  if (observers_->jerk) {
    single.jerk = [&](const trial::Jerk& jerk) {
      if (jerks++ >= reported_jerks) observers_->jerk(trial.number, jerk);
    };
  }
  if (observers_->sample) {
    single.sample = [&](const trial::SampleRecord& r) {
      if (r.k >= reported_samples)
        observers_->sample({trial.number, r.k, r.count, r.code, r.theta, r.xp, r.xh});
    };
  }
  *trial.outcome = trial::run_trial(*trial.parameters, single);
}

/// Restarts the lane's trial in run_trial: the kernels cannot follow its motion, or the count of its encoder
/// has overflowed.
void LaneScheduler::fall_back_to_scalar(int lane) {
  const LaneTrial& trial = trial_of(lane);
  run_scalar(trial, trial.reported_jerks,
             trial.first_sample + static_cast<std::int64_t>(batch_.measures.samples[lane]));
  refill(lane);
}

void LaneScheduler::add_outcome(int lane, LaneTrial& trial, bool stopped) {
  if (ahead_.contains(lane)) bring_up_to_date(batch_, lane, trial);
  ahead_.erase(lane);
  if (trial.jerks.end(static_cast<std::int64_t>(batch_.measures.samples[lane]))) report_jerk(trial);
  trial.outcome->moves.push_back(end_of_move(batch_, lane, trial, stopped));
}

void LaneScheduler::end_move(int lane, LaneTrial& trial) {
  add_outcome(lane, trial, false);
  ++trial.move;
  if (trial.move == trial.parameters->command.targets.size()) {
    refill(lane);
    return;
  }
  trial.first_sample += static_cast<std::int64_t>(batch_.measures.samples[lane]);
  start_move(batch_, lane, trial);
}

void LaneScheduler::stop_diverged(int lane, LaneTrial& trial) {
  add_outcome(lane, trial, true);
  trial.outcome->moves.resize(trial.parameters->command.targets.size(), trial::move_not_run());
  refill(lane);
}

}  // namespace zerocount::batch

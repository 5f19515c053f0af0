#include "core/batch/batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/batch/lane_rest.hpp"
#include "core/batch/lane_trial.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"
#include "core/trial/divergence.hpp"
#include "core/trial/trial.hpp"

namespace zerocount {
namespace {

using namespace batch;

constexpr int longest_delay = 64;

enum class LaneState : unsigned char {
  idle,      ///< without a trial
  sticking,  ///< the hook sticks
  waiting,   ///< for company in an event, the hook sticks
  sliding    ///< the hook slides
};

bool ideal(const EncoderErrors& e) {
  return e.eccentricity == 0.0 && e.interpolation == 0.0 && e.noise == 0.0 && e.missed == 0.0;
}

}  // namespace

bool runs_in_lanes(const TrialParameters& p) {
  const bool plain_loop = p.command.torque.levels.empty() && !p.command.targets.empty() &&
                          p.command.profile.shape == ReferenceShape::step &&
                          !has_coarse_phase(p.controller) && p.controller.encoder == EncoderChoice::fine &&
                          p.controller.delay <= longest_delay;
  const bool plain_devices = ideal(p.encoder.fine_errors) && ideal(p.encoder.coarse_errors) &&
                             !has_errors(p.dac) && p.amplifier.bandwidth == 0.0;
  const auto is_exponent = [](const ProfiledParameter& entry) {
    return entry.parameter == &FrictionParameters::n;
  };
  const bool square_law = p.friction.uniform.n == 2.0 &&
                          std::none_of(p.friction.profiled.begin(), p.friction.profiled.end(), is_exponent);
  const bool plain_friction = p.friction.model != FrictionModel::coulomb && square_law;
  return plain_loop && plain_devices && plain_friction && samples_of_move(p, 0) > 0;
}

/// The lanes, and one run of them through a batch.
struct BatchEngine::Work {
  explicit Work(const BatchSettings& settings)
      : kernels(kernels_of(settings.instructions)),
        lane_count(std::clamp(settings.lanes, 1, most_lanes)),
        lanes(static_cast<std::size_t>(lane_count)) {
    fill_spare_lane();
  }

  void run();

 private:
  using Notice = void (Work::*)(int lane, LaneTrial& trial, int note);

  void fill_spare_lane();
  void refill(int lane);
  void leave_to_reference(const LaneTrial& trial, std::int64_t told_jerks, std::int64_t told_samples);
  void end_move(int lane, LaneTrial& trial);
  void give_up(int lane);
  void end_trial(int lane);
  void stop_diverged(int lane, LaneTrial& trial);

  void take_samples();
  void record_sample(int lane, const LaneTrial& trial);
  void record_passed();
  void track_jerk(int lane, LaneTrial& trial);
  void end_jerk(int lane, LaneTrial& trial, double taken);
  void delay_torque(int lane, LaneTrial& trial);

  void move_sticking();
  void end_sticking_steps();
  void move_sliding();
  void end_sliding_steps();
  int list_due_lanes();
  int list_lanes(LaneState wanted);
  LaneState moving_state(int lane) const {
    return tile.motion.slide_direction[lane] == 0.0 ? LaneState::sticking : LaneState::sliding;
  }
  LaneState& state_of(int lane) { return states[static_cast<std::size_t>(lane)]; }
  LaneTrial& trial_of(int lane) { return lanes[static_cast<std::size_t>(lane)]; }

 public:
  const Kernels& kernels;
  int lane_count;
  std::vector<LaneTrial> lanes;
  std::array<LaneState, most_lanes> states{};
  Tile tile{};
  std::array<PassedSamples, most_lanes> passed{};
  std::array<int, most_lanes + 1> list{};
  std::array<int, most_lanes> slow_list{};
  std::array<int, most_lanes> waiting{};  ///< lanes with an event in their step
  int waiting_count{0};

  std::span<const TrialParameters* const> trials;
  std::span<TrialOutcome> outcomes;
  const BatchObservers* observers{nullptr};
  std::size_t next_trial{0};
  int running{0};
};

void BatchEngine::Work::fill_spare_lane() {
  // Anything finite will do: a trial of the defaults.
  static const TrialParameters parameters = [] {
    TrialParameters p;
    p.command.targets = {0};
    return p;
  }();
  LaneTrial spare;
  TrialOutcome outcome;
  start_trial(tile, spare_lane, spare, 0, parameters, outcome);
  tile.time.until[spare_lane] = tile.time.sample_time[spare_lane];
}

void BatchEngine::Work::run() {
  next_trial = 0;
  running = 0;
  tile.passed = observers->sample ? passed.data() : nullptr;
  for (int lane = 0; lane < lane_count; ++lane) refill(lane);
  while (running > 0) {
    take_samples();
    move_sticking();
    move_sliding();
  }
}

/// Gives the lane the next trial, if there is one; what lanes cannot run is run on the way.
void BatchEngine::Work::refill(int lane) {
  LaneTrial& trial = trial_of(lane);
  state_of(lane) = LaneState::idle;
  while (next_trial < trials.size()) {
    const std::size_t number = next_trial++;
    trial.parameters = trials[number];
    trial.number = number;
    trial.outcome = &outcomes[number];
    if (runs_in_lanes(*trials[number])) {
      outcomes[number].moves.clear();
      outcomes[number].moves.reserve(trials[number]->command.targets.size());
      start_trial(tile, lane, trial, number, *trials[number], outcomes[number]);
      state_of(lane) = moving_state(lane);
      ++running;
      return;
    }
    leave_to_reference(trial, 0, 0);
  }
}

/// The whole trial by run_trial. Of its jerks and samples, the first so many have been told already.
void BatchEngine::Work::leave_to_reference(const LaneTrial& trial, std::int64_t told_jerks,
                                           std::int64_t told_samples) {
  TrialObservers single;
  std::int64_t jerks = 0;
  if (observers->jerk) {
    single.jerk = [&](const Jerk& jerk) {
      if (jerks++ >= told_jerks) observers->jerk(trial.number, jerk);
    };
  }
  if (observers->sample) {
    single.sample = [&](const SampleRecord& r) {
      if (r.k >= told_samples) observers->sample({trial.number, r.k, r.count, r.code, r.theta, r.xp, r.xh});
    };
  }
  *trial.outcome = run_trial(*trial.parameters, single);
}

/// A motion that cannot be followed, or that has left what encoders can count: run_trial has the words for
/// it.
void BatchEngine::Work::give_up(int lane) {
  const LaneTrial& trial = trial_of(lane);
  leave_to_reference(trial, trial.told_jerks,
                     trial.first_sample + static_cast<std::int64_t>(tile.measures.taken[lane]));
  end_trial(lane);
}

void BatchEngine::Work::end_trial(int lane) {
  --running;
  refill(lane);
}

void BatchEngine::Work::end_move(int lane, LaneTrial& trial) {
  const double taken = tile.measures.taken[lane];
  if (tile.measures.in_jerk[lane] != 0.0) end_jerk(lane, trial, taken);
  trial.outcome->moves.push_back(outcome_of_move(tile, lane, trial));
  ++trial.move;
  if (trial.move == trial.parameters->command.targets.size()) {
    end_trial(lane);
    return;
  }
  trial.first_sample += static_cast<std::int64_t>(taken);
  start_move(tile, lane, trial);
}

void BatchEngine::Work::stop_diverged(int lane, LaneTrial& trial) {
  if (tile.measures.in_jerk[lane] != 0.0) end_jerk(lane, trial, tile.measures.taken[lane]);
  MoveOutcome move = outcome_of_move(tile, lane, trial);
  move.outcome = Outcome::oscillating;
  move.stopped = true;
  trial.outcome->moves.push_back(move);
  trial.outcome->moves.resize(trial.parameters->command.targets.size(), move_not_run());
  end_trial(lane);
}

void BatchEngine::Work::take_samples() {
  const int due = list_due_lanes();
  int count = 0;
  for (int i = 0; i < due; ++i) {
    const int lane = list[static_cast<std::size_t>(i)];
    if (tile.measures.taken[lane] == tile.measures.samples[lane]) {
      end_move(lane, trial_of(lane));
      if (state_of(lane) == LaneState::idle) continue;
    }
    list[static_cast<std::size_t>(count++)] = lane;
  }
  if (count == 0) return;
  kernels.sample(tile, {list.data(), count});
  for (int i = 0; i < tile.noted_count; ++i) {
    const int lane = tile.noted[i];
    if ((tile.note[lane] & beyond_kernel) == 0) continue;
    tile.note[lane] = no_note;
    tile.measures.taken[lane] -= 1.0;  // no encoder could count that
    give_up(lane);
  }
  if (observers->sample) {
    for (int i = 0; i < count; ++i) {
      const int lane = list[static_cast<std::size_t>(i)];
      const bool given_up = state_of(lane) == LaneState::idle || tile.measures.taken[lane] == 0.0;
      if (!given_up) record_sample(lane, trial_of(lane));
    }
  }
  for (int i = 0; i < tile.noted_count; ++i) {
    const int lane = tile.noted[i];
    const int note = tile.note[lane];
    LaneTrial& trial = trial_of(lane);
    if ((note & jerk_changes) != 0) track_jerk(lane, trial);
    if ((note & delayed) != 0) delay_torque(lane, trial);
    if ((note & diverges) != 0) stop_diverged(lane, trial);
  }
}

void BatchEngine::Work::record_sample(int lane, const LaneTrial& trial) {
  const auto k = static_cast<std::int64_t>(tile.measures.taken[lane]) - 1;
  observers->sample({trial.number, trial.first_sample + k, static_cast<std::int64_t>(tile.loop.count[lane]),
                     static_cast<std::int64_t>(tile.loop.code[lane]), tile.measures.theta[lane],
                     tile.measures.extension[lane], tile.motion.hardening[lane]});
}

/// The samples that steps have gone over, from their series.
void BatchEngine::Work::record_passed() {
  for (int i = 0; i < tile.passed_count; ++i) {
    const PassedSamples& p = passed[static_cast<std::size_t>(i)];
    const LaneTrial& trial = trial_of(p.lane);
    const double sample_time = tile.time.sample_time[p.lane];
    const double rate = tile.time.sample_rate[p.lane];
    const auto taken = static_cast<std::int64_t>(tile.measures.taken[p.lane] - p.samples);
    // The stop is `whole` samples after the first.
    const double whole = std::ceil(p.until * rate - 1e-9) - 1.0;
    for (int j = 0; j < static_cast<int>(p.samples); ++j) {
      const double x = (p.until - (whole - j) * sample_time) / p.step;
      const double extension =
          tile.motion.extension[p.lane] + (value_at(p.growth, x) - value_at(p.growth, p.end));
      observers->sample({trial.number, trial.first_sample + taken + j,
                         static_cast<std::int64_t>(tile.loop.count[p.lane]),
                         static_cast<std::int64_t>(tile.loop.code[p.lane]),
                         tile.motion.hook[p.lane] + value_at(p.elongation, x) + extension, extension,
                         std::abs(value_at(p.growth, x))});
    }
  }
}

/// As MoveMeasures has it.
void BatchEngine::Work::track_jerk(int lane, LaneTrial& trial) {
  MeasureLanes& q = tile.measures;
  const auto error = static_cast<std::int64_t>(tile.loop.error[lane]);
  const double k = q.taken[lane] - 1.0;
  if (error == 0) {
    end_jerk(lane, trial, k);
    return;
  }
  if (q.in_jerk[lane] == 0.0) {
    q.in_jerk[lane] = 1.0;
    trial.jerk_start = static_cast<std::int64_t>(k);
    trial.jerk = {static_cast<std::int64_t>(trial.move), k * tile.time.sample_time[lane], 0.0, 0,
                  error > 0 ? -1 : 1};
  }
  trial.jerk.magnitude = std::max(trial.jerk.magnitude, std::abs(error));
}

void BatchEngine::Work::end_jerk(int lane, LaneTrial& trial, double taken) {
  tile.measures.in_jerk[lane] = 0.0;
  trial.jerk.duration = (taken - static_cast<double>(trial.jerk_start)) * tile.time.sample_time[lane];
  ++trial.jerk_count;
  if (trial.jerk.direction > 0) ++trial.jerks_up;
  ++trial.told_jerks;
  if (observers->jerk) observers->jerk(trial.number, trial.jerk);
}

/// The torque that comes through the delay now. It stays as long as the decided one only where all that wait
/// are alike.
void BatchEngine::Work::delay_torque(int lane, LaneTrial& trial) {
  const double decided = tile.motion.torque[lane];
  const std::size_t size = trial.waiting.size();
  const double newest = trial.waiting[(trial.oldest_waiting + size - 1) % size];
  trial.waiting_alike = decided == newest ? trial.waiting_alike + 1 : 1;
  tile.motion.torque[lane] = trial.waiting[trial.oldest_waiting];
  trial.waiting[trial.oldest_waiting] = decided;
  trial.oldest_waiting = (trial.oldest_waiting + 1) % size;
  if (trial.waiting_alike <= static_cast<std::int64_t>(size)) {
    tile.time.samples_left[lane] = 1.0;
    tile.time.until[lane] = tile.time.sample_time[lane];
  }
}

/// Puts the lanes at a sampling instant into the list, and says how many.
int BatchEngine::Work::list_due_lanes() {
  int count = 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    list[static_cast<std::size_t>(count)] = lane;
    count +=
        tile.time.until[lane] == 0.0 && states[static_cast<std::size_t>(lane)] != LaneState::idle ? 1 : 0;
  }
  return count;
}

/// Puts the lanes of a state that are on their way into the list, and says how many.
int BatchEngine::Work::list_lanes(LaneState wanted) {
  int count = 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    list[static_cast<std::size_t>(count)] = lane;
    count += tile.time.until[lane] != 0.0 && states[static_cast<std::size_t>(lane)] == wanted ? 1 : 0;
  }
  return count;
}

void BatchEngine::Work::move_sticking() {
  int count = list_lanes(LaneState::sticking);
  if (count + waiting_count == 0) return;
  kernels.stick_start(tile, {list.data(), count});
  bool left = false;
  for (int i = 0; i < tile.noted_count; ++i) {
    const int lane = tile.noted[i];
    const int note = tile.note[lane];
    LaneTrial& trial = trial_of(lane);
    if ((note & ends_creep) != 0) end_creep(tile, lane, trial);
    if ((note & may_rest) != 0) {
      PassedSample record;
      if (observers->sample) {
        record = [&, before = static_cast<std::int64_t>(tile.measures.taken[lane])](
                     double sample, double theta, const CreepState& creep) {
          observers->sample(
              {trial.number, trial.first_sample + before - 1 + static_cast<std::int64_t>(sample),
               static_cast<std::int64_t>(tile.loop.count[lane]),
               static_cast<std::int64_t>(tile.loop.code[lane]), theta, creep.extension, creep.hardening});
        };
      }
      if (rest(tile, lane, trial, record)) {
        left = true;
        continue;
      }
      if (tile.motion.heading[lane] != tile.motion.direction[lane]) turn(tile, lane, trial);
    }
    if ((note & slides) != 0) {
      start_slide(tile, lane, trial);
      state_of(lane) = LaneState::sliding;
      left = true;
    }
    if ((note & turns) != 0) turn(tile, lane, trial);
  }
  if (left) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const int lane = list[static_cast<std::size_t>(i)];
      if (state_of(lane) == LaneState::sticking && tile.time.until[lane] != 0.0)
        list[static_cast<std::size_t>(kept++)] = lane;
    }
    count = kept;
    if (count == 0) return;
  }
  kernels.stick_step(tile, {list.data(), count});
  end_sticking_steps();
  // Few lanes at a time meet an event: they wait until there are enough of them, or nothing else to do.
  constexpr int enough = 8;
  if (waiting_count == 0 || (waiting_count < enough && count > waiting_count)) return;
  const int with_events = std::exchange(waiting_count, 0);
  std::sort(waiting.begin(), waiting.begin() + with_events);
  for (int i = 0; i < with_events; ++i) state_of(waiting[static_cast<std::size_t>(i)]) = LaneState::sticking;
  kernels.stick_event(tile, {waiting.data(), with_events});
  end_sticking_steps();
}

/// What the notes of a step ask for.
void BatchEngine::Work::end_sticking_steps() {
  if (observers->sample) record_passed();
  for (int i = 0; i < tile.noted_count; ++i) {
    const int lane = tile.noted[i];
    const int note = tile.note[lane];
    LaneTrial& trial = trial_of(lane);
    if ((note & meets_event) != 0) {
      state_of(lane) = LaneState::waiting;
      waiting[static_cast<std::size_t>(waiting_count++)] = lane;
      continue;
    }
    if ((note & closure) != 0) close_loop(tile, lane, trial);
    if ((note & creep_sets_in) != 0) tile.motion.creeping[lane] = 1.0;
    if ((note & creep_ends) != 0) end_creep(tile, lane, trial);
    if ((note & breaks_away) != 0) start_slide(tile, lane, trial);
    if ((note & beyond_kernel) != 0 && !advance_by_reference(tile, lane, trial)) {
      give_up(lane);
      continue;
    }
    state_of(lane) = moving_state(lane);
  }
}

void BatchEngine::Work::move_sliding() {
  const int sliding = list_lanes(LaneState::sliding);
  if (sliding == 0) return;
  int fast = 0;
  int slow = 0;
  for (int i = 0; i < sliding; ++i) {
    const int lane = list[static_cast<std::size_t>(i)];
    const bool is_fast = std::abs(tile.motion.omega[lane]) > tile.contact.fast_velocity[lane];
    (is_fast ? list[static_cast<std::size_t>(fast++)] : slow_list[static_cast<std::size_t>(slow++)]) = lane;
  }
  kernels.slide_fast(tile, {list.data(), fast});
  end_sliding_steps();
  kernels.slide_slow(tile, {slow_list.data(), slow});
  end_sliding_steps();
}

void BatchEngine::Work::end_sliding_steps() {
  for (int i = 0; i < tile.noted_count; ++i) {
    const int lane = tile.noted[i];
    const int note = tile.note[lane];
    LaneTrial& trial = trial_of(lane);
    if ((note & velocity_zero) != 0) end_slide(tile, lane, trial);
    if ((note & beyond_kernel) != 0 && !advance_by_reference(tile, lane, trial)) {
      give_up(lane);
      continue;
    }
    state_of(lane) = moving_state(lane);
  }
}

BatchEngine::BatchEngine(const BatchSettings& settings) : work_(std::make_unique<Work>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(std::span<const TrialParameters* const> trials, std::span<TrialOutcome> outcomes,
                      const BatchObservers& observers) {
  work_->trials = trials;
  work_->outcomes = outcomes;
  work_->observers = &observers;
  work_->run();
}

}  // namespace zerocount

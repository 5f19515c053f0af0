#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/plugin/arithmetic_mode.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/plugins/plugin_library.hpp"

namespace zerocount::plugins {
namespace {

constexpr std::int64_t max_trials_checked = 6;
constexpr double max_samples_checked = 2000.0;  // of each trial
constexpr std::size_t alignment = 64;           // of states, as zerocount/controller.h promises

using Samples = std::vector<trial::SampleRecord>;

/// Parameters of a trial of which every move is cut short, so that all its moves together have
/// max_samples_checked samples.
trial::TrialParameters start_of(const study::Study& study, std::int64_t point, std::int64_t index) {
  trial::TrialParameters p = study::study_trial(study, point, index).parameters;
  const double rate = p.controller.sample_rate;
  const auto moves = static_cast<double>(p.command.targets.size());
  p.command.hold = std::min(p.command.hold, std::max(2.0, max_samples_checked / moves) / rate);
  p.verdict.dwell = p.verdict.window = 1.0 / rate;
  return p;
}

/// Parameters of a few shortened trials (start_of()), spread evenly over the design points and their trials.
std::vector<trial::TrialParameters> some_trials(const study::Study& study) {
  const std::int64_t points = study::point_count(study);
  const std::int64_t count = std::min(max_trials_checked, study::trial_count(study));
  std::vector<trial::TrialParameters> trials;
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t row = i * (study::trial_count(study) / count);
    trials.push_back(start_of(study, points > 1 ? row / study.trials : 0, row % study.trials));
  }
  return trials;
}

Samples samples_of(const trial::TrialParameters& parameters) {
  Samples samples;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) { samples.push_back(record); };
  trial::run_trial(parameters, observers);
  return samples;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same(const Samples& a, const Samples& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return one.code == other.code && one.count == other.count && same_bits(one.theta, other.theta);
  });
}

/// Runs the user's controller without an axis, with inputs that were recorded in a trial.
class ControllerAlone {
 public:
  ControllerAlone(const trial::TrialParameters& p, const Samples& inputs)
      : functions_(*p.controller.user.plugin->functions),
        parameters_(p.controller.user.parameters),
        closes_at_load_(p.plant.load.encoder == motion::EncoderPlace::load),
        inputs_(&inputs),
        state_(functions_.state_size + alignment) {
    setup_ = {.size = sizeof(zerocount_setup),
              .parameter_count = static_cast<std::uint32_t>(parameters_.size()),
              .parameters = parameters_.data(),
              .sample_time = 1.0 / p.controller.sample_rate,
              .resolution = loop::fine_resolution(p.encoder),
              .torque_resolution = p.dac.resolution,
              .lowest_torque = loop::lowest_torque(p.dac),
              .highest_torque = loop::highest_torque(p.dac),
              .initial_integral = trial::initial_integral(p),
              .other_resolution = loop::has_other(p.encoder) ? loop::other_resolution(p.encoder) : 0.0};
    char message[256] = {};
    functions_.start(aligned(state_), &setup_, message, sizeof message);
    mode_.restore();
  }
  ControllerAlone(const ControllerAlone&) = delete;
  ControllerAlone& operator=(const ControllerAlone&) = delete;

  bool new_target() const { return k_ > 0 && (*inputs_)[k_].target != (*inputs_)[k_ - 1].target; }

  /// Runs the next sample of the controller. Returns the torque that it wants, N m.
  double step() {
    const trial::SampleRecord& record = (*inputs_)[k_];
    const zerocount_sample sample{
        .k = record.k,
        .time = record.t,
        .error = static_cast<double>(record.reference - record.count),
        .count = static_cast<double>(record.count),
        .reference = static_cast<double>(record.reference),
        .torque = k_ == 0 ? 0.0 : (*inputs_)[k_ - 1].torque,
        .velocity = 0.0,
        .acceleration = 0.0,
        .new_target = new_target() ? 1 : 0,
        .other_count = static_cast<double>(closes_at_load_ ? record.motor_count : record.load_count)};
    ++k_;
    const double torque = functions_.step(aligned(state_), &setup_, &sample);
    mode_.restore();
    return torque;
  }

  bool done() const { return k_ == inputs_->size(); }

  /// Copies the controller's state to another address, and overwrites it at the old one, so that a controller
  /// that keeps pointers into its state gives other torques.
  void move_state() {
    std::vector<std::byte> elsewhere(state_.size() + alignment);
    std::memcpy(aligned(elsewhere), aligned(state_), functions_.state_size);
    std::fill(state_.begin(), state_.end(), std::byte{0x5a});
    std::swap(state_, elsewhere);
  }

 private:
  static void* aligned(std::vector<std::byte>& bytes) {
    void* place = bytes.data();
    std::size_t space = bytes.size();
    return std::align(alignment, space - alignment, place, space);
  }

  const zerocount_controller& functions_;
  std::vector<double> parameters_;
  bool closes_at_load_;
  const Samples* inputs_;
  std::vector<std::byte> state_;
  zerocount_setup setup_{};
  plugin::ArithmeticMode mode_{};
  std::size_t k_{0};
};

/// [trial][sample] Torques of the controller, run for one trial after the other, N m.
/// @param inputs [trial] recorded samples that are its inputs
std::vector<std::vector<double>> torques_in_order(const std::vector<trial::TrialParameters>& trials,
                                                  const std::vector<Samples>& inputs) {
  std::vector<std::vector<double>> torques(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ControllerAlone controller(trials[i], inputs[i]);
    while (!controller.done()) torques[i].push_back(controller.step());
  }
  return torques;
}

/// [trial][sample] Torques of the controllers of all trials, run in turns sample by sample, while their
/// states move to other addresses, N m. They differ from torques_in_order() if a controller keeps something
/// outside its state.
/// @param inputs [trial] recorded samples that are their inputs
std::vector<std::vector<double>> torques_in_turns(const std::vector<trial::TrialParameters>& trials,
                                                  const std::vector<Samples>& inputs) {
  constexpr std::size_t samples_between_moves = 7;
  std::vector<std::vector<double>> torques(trials.size());
  std::vector<std::unique_ptr<ControllerAlone>> controllers;
  for (std::size_t i = 0; i < trials.size(); ++i)
    controllers.push_back(std::make_unique<ControllerAlone>(trials[i], inputs[i]));
  for (bool any = true; any;) {
    any = false;
    for (std::size_t i = trials.size(); i-- > 0;) {
      if (controllers[i]->done()) continue;
      any = true;
      torques[i].push_back(controllers[i]->step());
      if (torques[i].size() % samples_between_moves == 0) controllers[i]->move_state();
    }
  }
  return torques;
}

[[noreturn]] void refuse(const study::Study& study, std::string_view how) {
  throw Failure(ExitCode::bad_input,
                fmt::format("the controller {} keeps something outside its state: {}; expected all variables "
                            "in the state, without pointers into it, and no global or static variables",
                            study.plugin->description.name, how));
}

}  // namespace

void require_no_hidden_state(const study::Study& study) {
  if (!study.plugin || study.plugin->functions == nullptr) return;
  const std::vector<trial::TrialParameters> trials = some_trials(study);
  std::vector<Samples> first;
  first.reserve(trials.size());
  for (const trial::TrialParameters& trial : trials) first.push_back(samples_of(trial));
  for (std::size_t i = trials.size(); i-- > 0;) {
    if (!same(samples_of(trials[i]), first[i]))
      refuse(study, "a trial that is run again, in another order, gives other results");
  }
  const auto in_order = torques_in_order(trials, first);
  const auto in_turns = torques_in_turns(trials, first);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!std::equal(in_order[i].begin(), in_order[i].end(), in_turns[i].begin(), in_turns[i].end(),
                    same_bits))
      refuse(study, "trials run in turns, with their states moved to other addresses, give other results");
  }
}

}  // namespace zerocount::plugins

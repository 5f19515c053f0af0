#include "core/loop/controller/controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace zerocount::loop {

PhaseSwitch::PhaseSwitch(const CoarsePhaseParameters& rule, double sample_rate,
                         const CountsBefore& coarse_before)
    : rule_(rule),
      dwell_(std::max(1.0, std::round(rule.fine_dwell * sample_rate))),
      first_change_(counted_since(coarse_before, 1)) {}

bool PhaseSwitch::update(const Feedback& fine, const Feedback& coarse) {
  const bool first = !last_coarse_count_.has_value();
  const double count_change = first ? first_change_ : coarse.count - *last_coarse_count_;
  last_coarse_count_ = coarse.count;

  const bool settled =
      std::abs(coarse.error) <= rule_.fine_within && std::abs(count_change) <= rule_.fine_rate;
  const std::int64_t settled_before = phase_ == ControlPhase::coarse ? settled_ : 0;
  settled_ = settled ? settled_before + 1 : 0;

  const ControlPhase next = next_phase(fine);
  const bool changed = next != phase_ && !first;
  phase_ = next;
  if (changed) ++changes_;
  return changed;
}

ControlPhase PhaseSwitch::next_phase(const Feedback& fine) const {
  if (phase_ == ControlPhase::fine)
    return std::abs(fine.error) > rule_.coarse_beyond ? ControlPhase::coarse : ControlPhase::fine;
  return static_cast<double>(settled_) >= dwell_ ? ControlPhase::fine : ControlPhase::coarse;
}

ControllerParameters controller_in_phase(ControllerParameters controller, ControlPhase phase) {
  if (!has_coarse_phase(controller)) return controller;
  CoarsePhaseParameters coarse = std::exchange(controller.coarse, {});
  switch (phase) {
    case ControlPhase::fine:
      controller.kd = 0.0;
      break;
    case ControlPhase::coarse:
      controller.kp = coarse.kp;
      controller.ki = coarse.ki;
      controller.kd = coarse.kd;
      controller.blocks = std::move(coarse.blocks);
      controller.velocity_by_other = false;
      break;
  }
  return controller;
}

std::optional<ControllerParameters> controller_at_standstill(ControllerParameters controller) {
  const Standstill standstill = std::exchange(controller.blocks.standstill, {});
  if (standstill.band < 0.0 || controller.blocks.structure != ControlStructure::pid) return std::nullopt;
  controller.kp = standstill.kp;
  controller.ki = standstill.ki;
  controller.kd = standstill.kd;
  return controller;
}

LinearChain linear_chain(const ControllerParameters& parameters, const EncoderParameters& encoders) {
  return ControlChain(parameters, {.resolution = fine_resolution(encoders),
                                   .velocity_resolution = velocity_resolution(encoders, parameters)})
      .linear();
}

TorqueRange integral_range(AntiWindup anti_windup, double lowest, double highest) {
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  switch (anti_windup) {
    case AntiWindup::clamp:
      return {lowest, highest};
    case AntiWindup::none:
      break;
  }
  return {-unbounded, unbounded};
}

bool has_coarse_phase(const ControllerParameters& parameters) {
  return parameters.coarse.coarse_beyond < std::numeric_limits<double>::infinity();
}

namespace {

/// Counts, before the first sample, of the encoder that closes the loop of one control phase.
/// @param sample_rate Hz.
CountsBefore counts_before(const EncoderParameters& encoders, EncoderChoice encoder, double sample_rate,
                           const StartOfMotion& start) {
  const double sample_time = 1.0 / sample_rate;
  switch (encoder) {
    case EncoderChoice::coarse:
      return {coarse_encoder(encoders, start.phase), start.theta, start.velocity, sample_time,
              fine_per_coarse(encoders)};
    case EncoderChoice::fine:
      break;
  }
  return {fine_encoder(encoders, start.phase), start.theta, start.velocity, sample_time, 1.0};
}

ControlStart control_start(const ControllerParameters& parameters, const EncoderParameters& encoders,
                           ControlPhase phase, double integral, const DacScale& dac,
                           const StartOfMotion& start) {
  const bool fine = phase == ControlPhase::fine;
  const bool velocity_by_other = fine && parameters.velocity_by_other;
  const CountsBefore before = counts_before(encoders, fine ? parameters.encoder : parameters.coarse.encoder,
                                            parameters.sample_rate, start);
  const CountsBefore other_before{{other_resolution(encoders), start.other_phase},
                                  start.other_theta,
                                  start.velocity,
                                  1.0 / parameters.sample_rate,
                                  1.0};
  return {integral,
          integral_range(parameters.anti_windup, dac.range.lowest, dac.range.highest),
          fine_resolution(encoders),
          dac,
          velocity_by_other ? other_resolution(encoders) : fine_resolution(encoders),
          has_other(encoders) ? other_resolution(encoders) : 0.0,
          before,
          velocity_by_other ? other_before : before};
}

}  // namespace

Controller::Controller(const ControllerParameters& parameters, const EncoderParameters& encoders,
                       double integral, const DacScale& dac, const StartOfMotion& start)
    : two_phases_(has_coarse_phase(parameters)),
      fine_encoder_(parameters.encoder),
      coarse_encoder_(parameters.coarse.encoder),
      velocity_by_other_(parameters.velocity_by_other),
      fine_per_coarse_(loop::fine_per_coarse(encoders)),
      fine_(controller_in_phase(parameters, ControlPhase::fine),
            control_start(parameters, encoders, ControlPhase::fine, integral, dac, start)),
      // Without two phases it is not used, and a user's law must not be started twice.
      coarse_(two_phases_ ? controller_in_phase(parameters, ControlPhase::coarse) : ControllerParameters{},
              control_start(parameters, encoders, ControlPhase::coarse, integral, dac, start)),
      switch_(parameters.coarse, parameters.sample_rate,
              counts_before(encoders, parameters.coarse.encoder, parameters.sample_rate, start)) {}

void Controller::hold(double torque) {
  fine_.take_over(torque);
  coarse_.take_over(torque);
}

double Controller::update(std::int64_t reference, const EncoderReading& reading, double torque_in_force,
                          const ReferenceMotion& motion, bool new_target, std::int64_t sample) {
  const auto other = static_cast<double>(reading.other);
  const auto feedback = [&](EncoderChoice encoder, bool velocity_by_other) -> Feedback {
    const double count = count_of(encoder, reading);
    return {static_cast<double>(reference) - count, count, torque_in_force, motion, new_target, sample,
            velocity_by_other ? other : count,      other};
  };
  const Feedback fine = feedback(fine_encoder_, velocity_by_other_);
  if (!two_phases_) return fine_.step(fine);

  const Feedback coarse = feedback(coarse_encoder_, false);
  const bool changed = switch_.update(fine, coarse);
  const bool in_fine = switch_.phase() == ControlPhase::fine;
  ControlChain& deciding = in_fine ? fine_ : coarse_;
  ControlChain& resting = in_fine ? coarse_ : fine_;
  if (changed) deciding.take_over(torque_in_force);
  resting.observe(in_fine ? coarse : fine);
  return deciding.step(in_fine ? fine : coarse);
}

double Controller::integral() const {
  return (phase() == ControlPhase::fine ? fine_ : coarse_).integral();
}

double Controller::count_of(EncoderChoice encoder, const EncoderReading& reading) const {
  return encoder == EncoderChoice::fine ? static_cast<double>(reading.fine)
                                        : static_cast<double>(reading.coarse) * fine_per_coarse_;
}

}  // namespace zerocount::loop

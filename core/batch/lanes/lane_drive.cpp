#include "core/batch/lanes/lane_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/elementary_functions.hpp"
#include "core/trial/disturbance.hpp"
#include "core/trial/machine.hpp"

namespace zerocount::batch {
namespace {

motion::Disturbance varying_part(const trial::TrialParameters& p) {
  motion::Disturbance disturbance = trial::disturbance_of(p.disturbance, p.initial.position, p.randomness);
  disturbance.torque = 0.0;
  return disturbance;
}

}  // namespace

VibrationSeries::VibrationSeries(const std::vector<motion::Vibration>& lines, double sample_time)
    : sample_time_(sample_time) {
  lines_.reserve(lines.size());
  for (const motion::Vibration& of : lines) {
    const double turn = of.rate * sample_time;
    Line line{of, numerics::sin(turn), numerics::cos(turn), 0.0, 0.0, {}};
    double weight = of.amplitude;
    for (int k = 0; k <= vibration_order; ++k) {
      // The derivatives of sin are cos, −sin, −cos, sin, …
      line.weights[static_cast<std::size_t>(k)] = k % 4 < 2 ? weight : -weight;
      weight *= turn / (k + 1);
    }
    // A late sample is less than two sample times away. What the rest adds is lost in rounding.
    double power = std::abs(of.amplitude);
    std::size_t terms = 2;
    for (double k = 1.0; k <= vibration_order; k += 1.0) {
      power *= 2.0 * turn / k;
      if (power > 1e-18 * std::abs(of.amplitude)) terms = std::max(terms, static_cast<std::size_t>(k));
    }
    terms_ = std::max(terms_, std::min(terms + terms % 2, std::size_t{vibration_order}));
    lines_.push_back(line);
  }
}

VibrationSeries::Coefficients VibrationSeries::about_sample(std::int64_t k) {
  const bool anew = k % 256 == 0 || k != last_ + 1;
  last_ = k;
  Coefficients sum{};
  for (Line& line : lines_) {
    if (anew) {
      const double angle = line.of.rate * (static_cast<double>(k) * sample_time_) + line.of.phase;
      line.sine = numerics::sin(angle);
      line.cosine = numerics::cos(angle);
    } else {
      const double sine = line.sine * line.turn_cosine + line.cosine * line.turn_sine;
      line.cosine = line.cosine * line.turn_cosine - line.sine * line.turn_sine;
      line.sine = sine;
    }
    for (std::size_t j = 0; j < terms_; j += 2) {
      sum[j] += line.weights[j] * line.sine;
      sum[j + 1] += line.weights[j + 1] * line.cosine;
    }
    static_assert(vibration_order % 2 == 0);
    sum[terms_] += line.weights[terms_] * line.sine;
  }
  return sum;
}

LaneDrive::LaneDrive(const trial::TrialParameters& p)
    : sample_time_(1.0 / p.controller.sample_rate),
      jitters_(p.controller.jitter > 0.0),
      lags_(p.amplifier.bandwidth > 0.0),
      passes_on_(!jitters_ && !lags_ && p.controller.delay == 0.0),
      delayed_(static_cast<std::int64_t>(std::ceil(p.controller.delay))),
      clock_(p.controller, p.randomness),
      drive_(p.dac, p.amplifier, p.controller.delay, sample_time_, p.randomness, jitters_,
             trial::held_torque(p)),
      disturbance_(varying_part(p)),
      vibration_(lanes_have_lines() ? std::vector<motion::Vibration>{} : disturbance_.vibration,
                 sample_time_),
      last_torque_(trial::held_torque(p)),
      alike_(delayed_) {
  // Until the first sample, which may be late.
  late_.next = clock_.lateness(0);
  pieces_[0] = {motion::constant_torque(last_torque_), late_.next, 1.0};
  count_ = 1;
  piece_end_ = late_.next;
}

void LaneDrive::send(std::int64_t k, double torque) {
  late_ = {late_.next, clock_.lateness(k + 1)};
  alike_ = torque == last_torque_ ? alike_ + 1 : 1;
  last_torque_ = torque;
  count_ = 0;
  if (passes_on_) {
    pieces_[count_++] = {motion::constant_torque(torque), sample_time_, 1.0};
  } else {
    drive_.send_exact(torque, late_);
    for (const loop::TorquePiece& piece : drive_.pieces()) add(piece);
  }
  present_ = 0;
  piece_end_ = late_.now + pieces_[0].duration;
}

/// Appends a piece of the motor's torque (a time span with constant amplifier input). It is divided in two at
/// the instant at which its torque has settled.
void LaneDrive::add(const loop::TorquePiece& piece) {
  const double moves = motion::motor_is_constant(piece.course) ? 0.0 : motion::time_to_settle(piece.course);
  if (moves == 0.0 || moves >= piece.duration) {
    pieces_[count_++] = piece;
    return;
  }
  pieces_[count_++] = {piece.course, moves, piece.decay};
  pieces_[count_++] = {motion::constant_torque(piece.course.settled), piece.duration - moves, 1.0};
}

void LaneDrive::next_piece() {
  ++present_;
  piece_end_ += pieces_[present_].duration;
}

bool LaneDrive::stays() const {
  return !jitters_ && !disturbance_varies() && alike_ > delayed_ && count_ == 1 &&
         motion::motor_is_constant(pieces_[0].course);
}

}  // namespace zerocount::batch

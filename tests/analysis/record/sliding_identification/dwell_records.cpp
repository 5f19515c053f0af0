#include <array>
#include <cmath>
#include <numbers>

#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

class BristleMachine {
 public:
  BristleMachine(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random)
      : axis_(axis), loop_(loop), random_(random) {
    series_.name = "dwells.csv";
    series_.linear = true;
  }

  double read() {
    const double shaken = loop_.noise > 0.0 ? loop_.noise * normal_(random_) : 0.0;
    return loop_.resolution * std::floor((position_ + shaken) / loop_.resolution);
  }

  void act(double reading, double force) {
    series_.time.push_back(loop_.sample_time * static_cast<double>(series_.time.size()));
    series_.torque.push_back(force);
    series_.angle.push_back(reading);
    constexpr int steps = 20;
    for (int i = 0; i < steps; ++i) step(force, loop_.sample_time / steps);
  }

  records::RawSeries series() && { return std::move(series_); }

 private:
  /// Advances the velocity by `time` (s) under constant forces; the damper's force is included exactly.
  void kick(double force, double time) {
    const double net = force - axis_.offset - friction_;
    const double gone = -std::expm1(-axis_.damping / axis_.mass * time);
    velocity_ += gone * (net / axis_.damping - velocity_);
  }

  /// Advances the motion by `time` (s): kick, drift, kick (Strang splitting). The friction after a
  /// displacement is exact, because Dahl's law depends on the displacement alone; so is the motion while the
  /// bristles slide.
  void step(double force, double time) {
    kick(force, 0.5 * time);
    const double moved = time * velocity_;
    const double level = std::copysign(axis_.coulomb, moved);
    friction_ = level + (friction_ - level) * std::exp(-std::abs(moved) / axis_.bristle_travel);
    position_ += moved;
    kick(force, 0.5 * time);
  }

  BristleAxis axis_;
  DwellLoop loop_;
  std::mt19937_64& random_;
  std::normal_distribution<double> normal_;
  double position_{0.0};
  double velocity_{0.0};
  double friction_{0.0};
  records::RawSeries series_;
};

/// End position of a move. The moves go to and fro, with different lengths.
double target_of(int move, double amplitude) {
  constexpr std::array<double, 4> ends{1.0, -0.4, 0.7, -1.0};
  return move < 0 ? 0.0 : amplitude * ends[static_cast<std::size_t>(move) % ends.size()];
}

/// The reference position of a minimum-jerk move from `from` to `to` at the fraction `part` of its duration.
double least_jerk(double from, double to, double part) {
  if (part >= 1.0) return to;
  return from + (to - from) * part * part * part * (10.0 - 15.0 * part + 6.0 * part * part);
}

}  // namespace

records::RawSeries dwell_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random) {
  BristleMachine machine(axis, loop, random);
  const double rate = 2.0 * std::numbers::pi * loop.bandwidth;
  const double proportional = 0.6 * axis.mass * rate * rate;
  const double derivative = 1.6 * axis.mass * rate;
  const double integral = proportional * rate / 12.0;
  double sum = 0.0;
  double error_before = 0.0;
  const auto samples = static_cast<int>((loop.move + loop.dwell) / loop.sample_time);
  for (int move = 0; move < loop.moves; ++move) {
    for (int k = 0; k < samples; ++k) {
      const double reading = machine.read();
      const double reference = least_jerk(target_of(move - 1, loop.amplitude),
                                          target_of(move, loop.amplitude), k * loop.sample_time / loop.move);
      const double error = reference - reading;
      sum += integral * loop.sample_time * error;
      machine.act(reading,
                  sum + proportional * error + derivative * (error - error_before) / loop.sample_time);
      error_before = error;
    }
  }
  return std::move(machine).series();
}

records::RawSeries pulsed_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random) {
  BristleMachine machine(axis, loop, random);
  const auto samples = static_cast<int>((loop.move + loop.dwell) / loop.sample_time);
  std::uniform_real_distribution<double> strength(2.0, 6.0);
  for (int move = 0; move < loop.moves; ++move) {
    const double pulse = (move % 2 == 0 ? 1.0 : -1.0) * strength(random) * axis.coulomb;
    for (int k = 0; k < samples; ++k) {
      const double t = k * loop.sample_time;
      const double ramp = 0.8 * axis.coulomb * std::sin(2.0 * std::numbers::pi * t / loop.dwell);
      machine.act(machine.read(), axis.offset + (t < 0.5 * loop.move ? pulse : t < loop.move ? 0.0 : ramp));
    }
  }
  return std::move(machine).series();
}

}  // namespace zerocount::testing

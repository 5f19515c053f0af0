#include "core/theory/hunting.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "core/loop/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/numerics/dense.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"
#include "core/theory/stability.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

/// The root of f between low and high, where its values have opposite signs.
double sign_change(const std::function<double(double)>& f, double low, double high) {
  const bool rises = f(low) < 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    ((f(middle) < 0.0) == rises ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// The left side of the harmonic balance.
struct Balance {
  friction::FrictionModel model;
  const friction::FrictionParameters& contact;
  const motion::PlantParameters& plant;
  loop::LinearChain chain;
  double resolution;
  double sample_time;
  double delay;
  LinearDrive drive;
  loop::ErrorDeadband deadband;

  Complex control(double amplitude, double frequency) const {
    const Complex z = std::polar(1.0, frequency * sample_time);
    const Complex hold = (1.0 - 1.0 / z) / Complex(0.0, frequency * sample_time);
    const double corner = 2.0 * std::numbers::pi * drive.bandwidth;
    const Complex lag = corner > 0.0 ? 1.0 / Complex(1.0, frequency / corner) : 1.0;
    const double error_gain = describing_function(deadband, amplitude / resolution);
    return controller_response(z, chain, error_gain) * std::pow(z, -delay) * hold * lag * drive.gain /
           resolution;
  }
  Complex at(double amplitude, double frequency) const {
    return -plant.inertia * frequency * frequency +
           describing_function(model, contact, plant, amplitude, frequency) + control(amplitude, frequency);
  }
};

constexpr double amplitude_step = 1.25;
constexpr double frequency_step = 1.1;

/// The frequencies (rad/s) at which the stiffnesses balance the inertia.
std::vector<double> resonances(const Balance& balance, double amplitude) {
  std::vector<double> found;
  const double highest = 0.9 * std::numbers::pi / balance.sample_time;
  const auto stiffness = [&](double frequency) { return balance.at(amplitude, frequency).real(); };
  double low = 1e-4 * highest;
  double at_low = stiffness(low);
  for (double high = low * frequency_step; high < highest; high *= frequency_step) {
    const double at_high = stiffness(high);
    if ((at_low < 0.0) != (at_high < 0.0)) found.push_back(sign_change(stiffness, low, high));
    low = high;
    at_low = at_high;
  }
  return found;
}

/// The one of `resonances` nearest to `frequency` on a logarithmic scale; empty if all differ by more than a
/// factor of 1.3.
std::optional<double> nearest(const std::vector<double>& resonances, double frequency) {
  std::optional<double> best;
  for (const double candidate : resonances) {
    const double ratio = std::max(candidate / frequency, frequency / candidate);
    if (ratio < 1.3 && (!best || ratio < std::max(*best / frequency, frequency / *best))) best = candidate;
  }
  return best;
}

/// A slide of the stick-slip cycle with a = 1 and Fs − Fc = `excess`: x, t and w at v = 0.
struct SlideEnd {
  double x;
  double w;
  double time;
};

std::optional<SlideEnd> slide_end(const Eigen::Matrix3d& generator, double stiffness, double excess) {
  Eigen::Vector3d state(-1.0, 0.0, excess - stiffness);
  const double interval = 0.02 / numerics::spectral_radius(generator);
  const Eigen::Matrix3d flow = numerics::matrix_exponential(generator * interval);
  constexpr int max_steps = 200000;
  for (int k = 0; k < max_steps; ++k) {
    const Eigen::Vector3d next = flow * state;
    if (k > 0 && next[1] <= 0.0) {
      const auto after = [&](double t) -> Eigen::Vector3d {
        return Eigen::Matrix3d(numerics::matrix_exponential(generator * t)) * state;
      };
      const auto velocity = [&](double t) { return after(t)[1]; };
      double low = 0.0;
      double high = interval;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (velocity(middle) > 0.0 ? low : high) = middle;
      }
      const Eigen::Vector3d end = after(high);
      return SlideEnd{end[0], end[2], k * interval + high};
    }
    state = next;
  }
  return std::nullopt;
}

}  // namespace

std::vector<LimitCycle> harmonic_balance(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant,
                                         const loop::EncoderParameters& encoder,
                                         const loop::ControllerParameters& controller,
                                         const LinearDrive& drive) {
  std::vector<LimitCycle> cycles;
  if (!has_describing_function(model)) return cycles;
  const double resolution = loop::fine_resolution(encoder);
  const Balance balance{model,
                        contact,
                        plant,
                        loop::linear_chain(controller, resolution),
                        resolution,
                        sample_time(controller),
                        controller.delay,
                        drive,
                        controller.blocks.error_deadband};
  double low = 0.3 * resolution;
  std::vector<double> at_low = resonances(balance, low);
  for (double high = low * amplitude_step; high < 1e6 * resolution; high *= amplitude_step) {
    const std::vector<double> at_high = resonances(balance, high);
    for (const double start : at_low) {
      const std::optional<double> end = nearest(at_high, start);
      if (!end || !(balance.at(low, start).imag() < 0.0 && balance.at(high, *end).imag() > 0.0)) continue;
      double frequency = start;
      const auto damping = [&](double amplitude) {
        frequency = nearest(resonances(balance, amplitude), frequency).value_or(frequency);
        return balance.at(amplitude, frequency).imag();
      };
      double inner = low;
      double outer = high;
      for (int i = 0; i < 20; ++i) {
        const double middle = std::sqrt(inner * outer);
        (damping(middle) < 0.0 ? inner : outer) = middle;
      }
      cycles.push_back({outer, 2.0 * std::numbers::pi / frequency});
    }
    low = high;
    at_low = at_high;
  }
  return cycles;
}

std::string_view left_out_of_hunting(const motion::PlantParameters& plant,
                                     const loop::ControllerParameters& controller) {
  if (motion::has_load(plant)) return "the second mass";
  if (controller.blocks.deadband.enter > 0.0) return "the deadband";
  if (controller.blocks.hold.enter >= 0.0) return "the hold";
  if (controller.blocks.standstill.band >= 0.0) return "the gains at standstill";
  return std::isfinite(controller.blocks.integrator_zone) ? "the integrator zone" : "";
}

std::optional<LimitCycle> stick_slip_cycle(const friction::FrictionParameters& contact,
                                           const motion::PlantParameters& plant,
                                           const loop::EncoderParameters& encoder,
                                           const loop::ControllerParameters& controller) {
  if (contact.coulomb_ratio == 1.0 || !(controller.ki > 0.0) || controller.blocks.error_deadband.band > 0.0 ||
      !left_out_of_criteria(plant, controller).empty())
    return std::nullopt;
  const AnalogueGains gains = analogue_gains(controller, encoder);
  Eigen::Matrix3d generator;
  generator << 0.0, 1.0, 0.0, -gains.kp / plant.inertia, -(gains.kd + plant.sliding_damping) / plant.inertia,
      1.0 / plant.inertia, -gains.ki, 0.0, 0.0;
  // The length of a slide grows with Fs − Fc, from that by the integral alone without bound.
  const auto beyond = [&](double excess) {
    const std::optional<SlideEnd> end = slide_end(generator, gains.kp, excess);
    return end ? end->x - 1.0 : -1.0;  // it approaches its target without end
  };
  const double scale = gains.kp + gains.ki / numerics::spectral_radius(generator);  // N m/rad
  const double lowest = 1e-6 * scale;
  const double highest = 1e6 * scale;
  if (beyond(lowest) >= 0.0 || beyond(highest) < 0.0) return std::nullopt;
  const double excess = sign_change(beyond, lowest, highest);
  const std::optional<SlideEnd> end = slide_end(generator, gains.kp, excess);
  const double amplitude = contact.breakaway * (1.0 - contact.coulomb_ratio) / excess;
  const double torque = (end->w - gains.kp) * amplitude + contact.coulomb_ratio * contact.breakaway;
  if (!(std::abs(torque) <= contact.breakaway)) return std::nullopt;  // it would not stick there
  const double stand = (torque + contact.breakaway) / (gains.ki * amplitude);
  return LimitCycle{amplitude, 2.0 * (end->time + stand)};
}

}  // namespace zerocount::theory

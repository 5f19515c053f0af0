#include "core/theory/hunting.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>

#include "core/friction/bristles/bristle.hpp"
#include "core/friction/sliding/stribeck.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/encoder.hpp"
#include "core/numerics/bisection.hpp"
#include "core/theory/describing_function.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/gains.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t alike = 6;  // cycles at the end of a motion that has settled

/// Whether the last cycles are alike.
bool have_settled(const std::vector<LimitCycle>& cycles, double tolerance) {
  if (cycles.size() < alike) return false;
  const LimitCycle& last = cycles.back();
  return std::all_of(cycles.end() - alike, cycles.end(), [&](const LimitCycle& one) {
    return std::abs(one.amplitude - last.amplitude) < tolerance * last.amplitude &&
           std::abs(one.period - last.period) < tolerance * last.period;
  });
}

LimitCycle mean_of(std::vector<LimitCycle>::const_iterator from, std::vector<LimitCycle>::const_iterator to) {
  LimitCycle mean{0.0, 0.0};
  const auto count = static_cast<double>(to - from);
  for (; from != to; ++from) {
    mean.amplitude += from->amplitude / count;
    mean.period += from->period / count;
  }
  return mean;
}

/// The root of f between low and high, where its values have opposite signs.
double sign_change(const std::function<double(double)>& f, double low, double high) {
  const bool rises = f(low) < 0.0;
  const auto is_before = [&](double at) { return (f(at) < 0.0) == rises; };
  const auto [before, after] =
      numerics::bisect({low, high}, is_before, numerics::after_halvings(60), numerics::geometric_mean);
  return numerics::geometric_mean(before, after);
}

/// The states of a loop whose rotor has stood at `count`, while the error was 0.
Eigen::VectorXd standing_at(double count, FrozenLoop loop) {
  for (loop::LinearBlock& block : loop.controller) {
    for (loop::SignalPath& path : block) {
      if (path.from == loop::LoopSignal::error) std::ranges::fill(path.transfer.b, 0.0);
    }
  }
  const Eigen::MatrixXd map = loop_map(loop.plant, loop.controller);
  constexpr int max_samples = 20'000;
  Eigen::VectorXd state = Eigen::VectorXd::Zero(map.rows());
  for (int i = 0; i < max_samples; ++i) {
    state[0] = count;
    state[1] = 0.0;
    state = map * state;
  }
  state[0] = count;
  state[1] = 0.0;
  return state;
}

/// The amplitude (counts) below which an encoder reads one count at most: it does not see the oscillation.
constexpr double min_amplitude = 1.0;

/// Friction that follows its level g over a travel of g/σ0, or at once.
struct SlidingFriction {
  friction::StribeckCurve level;
  double stiffness;        ///< σ0, N m/rad; infinite for a relay
  double bristle_damping;  ///< σ1, N m s/rad
  double damping;          ///< of the rotor, N m s/rad
  double breakaway;        ///< N m

  /// How the rotor breaks away while the torque grows by `growth` (N m/s): a bristle that is loaded so fast
  /// slides before its torque is that of breakaway. Slowly loaded, F = σ0·z = g(ω)·(1 − dz/dt/ω), so that the
  /// largest F over ω is carried.
  struct Start {
    double torque;    ///< N m
    double velocity;  ///< rad/s
  };
  Start start_under(double growth) const {
    Start start{breakaway, 0.0};
    if (std::isinf(stiffness)) return start;
    start.torque = 0.0;
    const double fastest = 10.0 / std::sqrt(level.per_velocity_squared);
    for (double velocity = 1e-5 * fastest; velocity < fastest; velocity *= 1.05) {
      const double torque = friction::level_at(level, velocity) * (1.0 - growth / (stiffness * velocity));
      if (torque > start.torque) start = {torque, velocity};
    }
    return start.torque > 0.0 ? start : Start{breakaway, 0.0};
  }
  /// Travel (rad) of the bristle from a torque in the direction of motion to that at which it breaks away.
  double yield(double from, double to) const {
    if (std::isinf(stiffness)) return 0.0;
    const double rest = std::max(1e-6, 1.0 - to / breakaway);
    return breakaway / stiffness * std::log(std::max(rest, 1.0 - from / breakaway) / rest);
  }

  /// σ0·z after a travel (rad) under the level g.
  double after(double torque, double g, double travel) const {
    return g + (torque - g) * std::exp(-travel * stiffness / g);
  }
  /// Mean of σ0·z + σ1·dz/dt over a travel (rad) that takes `duration` (s).
  double mean(double torque, double g, double travel, double duration) const {
    const double lengths = travel * stiffness / g;
    if (std::isinf(stiffness)) return g;
    const double part = lengths > 1e-6 ? -std::expm1(-lengths) / lengths : 1.0;
    return g + (torque - g) * part +
           bristle_damping * (after(torque, g, travel) - torque) / (stiffness * duration);
  }
};

SlidingFriction sliding_friction(friction::FrictionModel model, const friction::FrictionParameters& contact,
                                 const motion::PlantParameters& plant) {
  const friction::LawTraits& law = friction::traits_of(model);
  if (law.bristle == nullptr) {
    return {friction::stribeck_curve(contact), std::numeric_limits<double>::infinity(), 0.0,
            plant.sliding_damping, contact.breakaway};
  }
  const friction::BristleParameters bristle = law.bristle(plant, contact);
  return {bristle.level, bristle.stiffness, bristle.bristle_damping, bristle.damping,
          friction::level_at(bristle.level, 0.0)};
}

/// The sampled loop on such friction, the count a continuous quantity: the linear map of the loop while it
/// slides, with the friction torque added, and the rotor held while it sticks. Time is in samples.
class StickSlip {
 public:
  StickSlip(const SlidingFriction& friction, const motion::PlantParameters& plant,
            const loop::EncoderParameters& encoder, const loop::ControllerParameters& controller,
            const LinearDrive& drive, double first_step)
      : friction_(friction), resolution_(loop::fine_resolution(encoder)), T_(sample_time(controller)) {
    const FrozenLoop loop = frozen_loop(0.0, friction.damping, plant, encoder, controller, drive);
    map_ = loop_map(loop.plant, loop.controller);
    damped_ = loop.plant.A(1, 1);
    by_torque_ = hold_plant(0.0, friction.damping, plant, resolution_, T_, {}).b;
    state_ = standing_at(-first_step, loop);
  }

  double time() const { return time_; }
  double count() const { return state_[0]; }
  bool sticks() const { return sticks_; }
  /// Whether the rotor stands where the encoder reads the target, where the bristle yields as far as the
  /// target before it slides, or under a torque that does not change.
  bool rests() const { return stuck_samples_ > patience() && (is_constant_ || reaches_target()); }

  /// Goes on by a sample, or while the rotor sticks under a torque in even growth, to the last one before it
  /// breaks away.
  void advance() {
    const Eigen::VectorXd free = map_ * state_;
    const double rate = state_[1];
    const double torque = (free[1] - damped_ * rate) / by_torque_[1];
    const bool holds = sticks_ ? std::abs(torque) <= start_.torque : std::abs(torque) <= friction_.breakaway;
    if (rate == 0.0 && holds) {
      stick(free, torque);
    } else if (sticks_) {
      break_away(torque);
    } else {
      slide(free, rate, torque);
    }
  }

 private:
  Eigen::Index patience() const { return map_.rows() + 10; }

  bool reaches_target() const {
    const double sign = std::copysign(1.0, last_growth_);
    if (sign * count() > 0.0) return std::abs(count()) < 0.5;
    return std::abs(count()) < 0.5 + friction_.yield(sign * stop_torque_, start_.torque) / resolution_;
  }

  void stick(Eigen::VectorXd next, double torque) {
    next[0] = state_[0];
    next[1] = 0.0;
    const Eigen::VectorXd change = next - state_;
    const auto is_small = [&](const Eigen::VectorXd& of, double relative) {
      return ((of.cwiseAbs() - relative * change.cwiseAbs() - 1e-14 * state_.cwiseAbs()).array() <= 0.0)
          .all();
    };
    is_constant_ = stuck_samples_ > 0 && is_small(change, 0.0);
    const double growth = torque - last_torque_;
    const bool is_new = !(std::abs(growth - last_growth_) <= 1e-3 * std::abs(last_growth_));
    if (sticks_ && is_new) start_ = friction_.start_under(std::abs(growth) / T_);
    if (!sticks_) start_ = {friction_.breakaway, 0.0};
    if (is_new) last_growth_ = growth;
    const bool is_even = stuck_samples_ > patience() && is_small(change - last_change_, 1e-6);
    last_torque_ = torque;
    last_change_ = change;
    sticks_ = true;
    ++stuck_samples_;
    double samples = 1.0;
    if (is_even && growth != 0.0)
      samples = std::max(1.0, std::floor((std::copysign(start_.torque, growth) - torque) / growth) - 1.0);
    state_ += samples * change;
    time_ += samples;
  }

  /// The elastic travel is made at once.
  void break_away(double torque) {
    sticks_ = false;
    stuck_samples_ = 0;
    const double sign = std::copysign(1.0, torque);
    state_[0] += sign * friction_.yield(sign * stop_torque_, start_.torque) / resolution_;
    state_[1] = sign * start_.velocity * T_ / resolution_;
    bristle_torque_ = start_.torque;
    if (start_.velocity > 0.0) return;
    slide(map_ * state_, 0.0, torque);
  }

  double level(double rate) const {
    return friction::level_at(friction_.level, std::abs(rate) * resolution_ / T_);
  }

  /// The level is that at the mean velocity of the sample.
  void slide(Eigen::VectorXd next, double rate, double torque) {
    const double sign = rate != 0.0 ? std::copysign(1.0, rate) : std::copysign(1.0, torque);
    const double free_count = next[0];
    const double free_rate = next[1];
    double mean_rate = std::abs(rate);
    for (int i = 0; i < 3; ++i) {
      const double opposing =
          sign * friction_.mean(bristle_torque_, level(mean_rate), mean_rate * resolution_, T_);
      next[0] = free_count - opposing * by_torque_[0];
      next[1] = free_rate - opposing * by_torque_[1];
      mean_rate = std::max(0.0, sign * 0.5 * (rate + next[1]));
    }
    bristle_torque_ = friction_.after(bristle_torque_, level(mean_rate), mean_rate * resolution_);
    if (rate != 0.0 && next[1] * sign <= 0.0) turn(next, rate, torque);
    state_ = next;
    time_ += 1.0;
  }

  /// The velocity reaches 0 within the sample: the rotor sticks there, or goes back.
  void turn(Eigen::VectorXd& next, double rate, double torque) {
    const double part = rate / (rate - next[1]);
    stop_torque_ = std::copysign(bristle_torque_, rate);
    next[0] = state_[0] + 0.5 * part * rate;
    next[1] = 0.0;
    if (std::abs(torque) <= friction_.breakaway) return;
    bristle_torque_ = level(0.0);
    const double back = (torque - std::copysign(level(0.0), torque)) * by_torque_[1] * (1.0 - part);
    next[0] += 0.5 * (1.0 - part) * back;
    next[1] = back;
  }

  SlidingFriction friction_;
  double resolution_;           ///< rad
  double T_;                    ///< s
  double bristle_torque_{0.0};  ///< σ0·z against the motion, N m
  double stop_torque_{0.0};     ///< σ0·z at the last stop, N m
  SlidingFriction::Start start_{friction_.breakaway, 0.0};
  Eigen::MatrixXd map_;
  double damped_;              ///< of a velocity, what a sample leaves of it
  Eigen::VectorXd by_torque_;  ///< counts and counts a sample, by 1 N m over a sample
  Eigen::VectorXd state_, last_change_;
  double last_torque_{0.0};
  double last_growth_{0.0};
  double time_{0.0};
  Eigen::Index stuck_samples_{0};
  bool sticks_{true};
  bool is_constant_{false};
};

/// The mean of the last of many cycles. Of few samples each, they differ from one to the next, and last if
/// they do not shrink.
std::optional<LimitCycle> mean_of_uneven(const std::vector<LimitCycle>& cycles) {
  constexpr std::ptrdiff_t window = 50;
  if (std::ssize(cycles) < 2 * window) return std::nullopt;
  const LimitCycle before = mean_of(cycles.end() - 2 * window, cycles.end() - window);
  const LimitCycle last = mean_of(cycles.end() - window, cycles.end());
  constexpr double alike_within = 0.05;
  constexpr double few_samples = 200.0;
  if (last.period > few_samples ||
      std::abs(last.amplitude - before.amplitude) > alike_within * before.amplitude)
    return std::nullopt;
  return last;
}

/// The cycle to which the motion settles, in counts and samples; none if it comes to rest or grows without
/// bound.
std::optional<LimitCycle> lasting_cycle(StickSlip& motion) {
  constexpr int max_cycles = 300;
  constexpr int max_steps = 1'000'000;
  constexpr double settled = 5e-3;
  constexpr double beyond = 1e12;  // counts
  double last_count = motion.count();
  double last_time = 0.0;
  double crossed = std::numeric_limits<double>::quiet_NaN();
  double low = last_count;
  double high = last_count;
  std::vector<LimitCycle> cycles;
  for (int i = 0; i < max_steps && static_cast<int>(cycles.size()) < max_cycles; ++i) {
    motion.advance();
    const double count = motion.count();
    if (motion.rests() || !(std::abs(count) < beyond)) return std::nullopt;
    low = std::min(low, count);
    high = std::max(high, count);
    if (last_count < 0.0 && count >= 0.0) {
      const double at = last_time + (motion.time() - last_time) * last_count / (last_count - count);
      if (!std::isnan(crossed)) cycles.push_back({0.5 * (high - low), at - crossed});
      crossed = at;
      low = high = count;
      if (have_settled(cycles, settled)) return mean_of(cycles.end() - alike, cycles.end());
    }
    last_count = count;
    last_time = motion.time();
  }
  return mean_of_uneven(cycles);
}

/// The left side of the harmonic balance.
struct Balance {
  friction::FrictionModel model;
  const friction::FrictionParameters& contact;
  const motion::PlantParameters& plant;
  ControllerResponse controller;
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
    return controller.at(z, error_gain) * std::pow(z, -delay) * hold * lag * drive.gain / resolution;
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
                        ControllerResponse(loop::linear_chain(controller, resolution)),
                        resolution,
                        sample_time(controller),
                        controller.delay,
                        drive,
                        controller.blocks.error_deadband};
  double low = min_amplitude * resolution;
  std::vector<double> at_low = resonances(balance, low);
  for (double high = low * amplitude_step; high < 1e6 * resolution; high *= amplitude_step) {
    const std::vector<double> at_high = resonances(balance, high);
    for (const double start : at_low) {
      const std::optional<double> end = nearest(at_high, start);
      if (!end || !(balance.at(low, start).imag() < 0.0 && balance.at(high, *end).imag() > 0.0)) continue;
      double frequency = start;
      const auto grows = [&](double amplitude) {
        frequency = nearest(resonances(balance, amplitude), frequency).value_or(frequency);
        return balance.at(amplitude, frequency).imag() < 0.0;
      };
      const double amplitude =
          numerics::bisect({low, high}, grows, numerics::after_halvings(20), numerics::geometric_mean).fails;
      cycles.push_back({amplitude, 2.0 * std::numbers::pi / frequency});
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

std::vector<LimitCycle> stick_slip_cycle(friction::FrictionModel model,
                                         const friction::FrictionParameters& contact,
                                         const motion::PlantParameters& plant,
                                         const loop::EncoderParameters& encoder,
                                         const loop::ControllerParameters& controller,
                                         const LinearDrive& drive, double first_step) {
  if (controller.blocks.error_deadband.band > 0.0) return {};
  StickSlip motion(sliding_friction(model, contact, plant), plant, encoder, controller, drive, first_step);
  const std::optional<LimitCycle> cycle = lasting_cycle(motion);
  if (!cycle || cycle->amplitude < min_amplitude) return {};
  return {{cycle->amplitude * loop::fine_resolution(encoder), cycle->period * sample_time(controller)}};
}

}  // namespace zerocount::theory

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/loop/controller/cascade.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/loop/controller/disturbance_observer.hpp"
#include "core/loop/controller/feedforward.hpp"
#include "core/loop/controller/filter.hpp"
#include "core/loop/controller/pid.hpp"
#include "core/loop/controller/torque_hold.hpp"
#include "core/loop/dac.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {
namespace {

/// Maximum number of samples in the window of the velocity estimate, or in the latency of a command. Each
/// sample of them needs a variable of its own in the written code.
constexpr int max_queue = 64;

/// Writes the controller of a study as a program, block by block. The constants and states of a block become
/// named variables. Its statements come from the same formulas (core/loop) that the simulation uses, computed
/// with Term instead of numbers.
class ChainWriter {
 public:
  ChainWriter(const ControllerToWrite& of, Precision precision)
      : of_(of),
        blocks_(of.controller.blocks),
        sample_rate_(of.controller.sample_rate),
        single_(precision == Precision::single_precision),
        torque_unit_(parameters::unit_on(of.axis, "N m")),
        angle_unit_(parameters::unit_on(of.axis, "rad")),
        write_(precision, angle_unit_, torque_unit_, of.controller.velocity_by_other) {}

  Program program() {
    start();
    write_error();
    if (cascade_) {
      write_command();
    } else {
      write_standstill();
    }
    if (blocks_.hold.enter < 0.0) {
      write_chain();
    } else {
      write_hold();
    }
    shift(last_counts_, velocity_count_);
    write_.assign(started_, Term(1.0));
    write_dither();
    const double limit = of_.dac.limit;
    if (limit < unbounded) {
      const Term most = write_.constant("torque_limit", limit, "of the amplifier, " + torque_unit_);
      write_.assign(u_, loop::clamped<Term>(u_, -most, most));
    }
    return write_.finished(u_);
  }

 private:
  Term state(const std::string& name, const std::string& meaning, Type type = Type::number,
             double initial = 0.0) {
    return write_.variable({name, Role::state, type, meaning, initial});
  }
  /// Declares state variables for the values of the last `length` samples, the oldest first.
  /// @param name beginning of the variables' names
  /// @param unit text of the unit, for their comments
  std::vector<Term> queue(const std::string& name, int length, const std::string& unit,
                          Type type = Type::number) {
    if (length == 1) return {state(name, "at the sample before, " + unit, type)};
    std::vector<Term> states;
    for (int i = length; i > 0; --i)
      states.push_back(
          state(fmt::format("{}_{}", name, i), fmt::format("{} samples before, {}", i, unit), type));
    return states;
  }
  void shift(const std::vector<Term>& queue, const Term& newest) {
    for (std::size_t i = 0; i < queue.size(); ++i)
      write_.assign(queue[i], i + 1 < queue.size() ? queue[i + 1] : newest);
  }
  Term local(const std::string& name, Type type = Type::number) {
    return write_.variable({name, Role::local, type});
  }
  /// A named constant for the coefficient. If it has the value with which it has no effect, only this
  /// literal, so that the formulas leave it out.
  Term coefficient(const std::string& name, double value, const std::string& meaning,
                   double without_effect = 0.0) {
    return value == without_effect ? Term(value) : write_.constant(name, value, meaning);
  }
  /// Text of the unit torque per divisor, such as "N m/count".
  std::string torque_per(std::string_view divisor) const {
    return fmt::format("{}/{}", torque_unit_, divisor);
  }

  Term difference_of_counts(const Term& a, const Term& b) const {
    return single_ ? Term(Operation::count_difference, {a, b}) : a - b;
  }

  /// Declares the variables that the controller needs for the counts of earlier samples and of the first
  /// sample, and writes code that sets all of them to the present count at the first sample.
  void start() {
    const bool differs = cascade_ || of_.controller.kd != 0.0 || (stands_ && blocks_.standstill.kd != 0.0);
    if (differs) last_counts_ = queue("last_count", blocks_.derivative_window, "counts", Type::count);
    if (blocks_.observer.bandwidth > 0.0)
      first_count_ = state("first_count", "at the first sample, counts", Type::count);
    if (last_counts_.empty() && !first_count_) return;
    write_.branch(!started_, [&] {
      for (const Term& last : last_counts_) write_.assign(last, velocity_count_);
      if (first_count_) write_.assign(*first_count_, velocity_count_);
    });
  }

  /// Writes the statements that compute e′, the position error (counts) after its dead band. Without a dead
  /// band, e′ is the error.
  void write_error() {
    const loop::ErrorDeadbandConstants<double> zone = loop::error_deadband_constants(blocks_.error_deadband);
    if (!(zone.band > 0.0)) return;
    const Term band = write_.constant("error_deadband", zone.band, "errors that count as 0, counts");
    e_ = local("acting_error");
    write_.assign(e_, loop::acting_error<Term>({band, zone.subtracted > 0.0 ? band : Term(0.0)}, error_));
  }

  void write_standstill() {
    if (!stands_) return;
    const loop::StandstillConstants<double> c = loop::standstill_constants(blocks_.standstill, sample_rate_);
    write_.remark("the gains at standstill act once the error has stayed within the band");
    const Term still = state("still", "samples for which the error has been within the band of standstill");
    const Term band = write_.constant("standstill_band", c.band, "counts");
    const Term dwell = write_.constant("standstill_dwell", c.dwell, "samples");
    Term run = still;
    const Term stands = loop::stands_still<Term>({band, dwell, c.kp, c.ki, c.kd}, run, new_target_, error_);
    write_.assign(still, run);
    stands_now_ = local("stands", Type::flag);
    write_.assign(*stands_now_, stands);
  }

  void write_hold() {
    const loop::HoldConstants<double> c = loop::hold_constants(blocks_.hold, sample_rate_);
    write_.remark("hold of the torque at standstill");
    const Term within = state("within", "samples for which the error has been within the hold");
    const Term holding = state("holding", "the torque is held", Type::flag);
    const Term held = state("held", "wanted at the sample before, " + torque_unit_);
    const Term enter = write_.constant("hold_enter", c.enter, "counts");
    const Term leave = c.leave == c.enter ? enter : write_.constant("hold_leave", c.leave, "counts");
    const Term dwell = write_.constant("hold_dwell", c.dwell, "samples");
    const Term fresh = local("fresh", Type::flag);
    write_.assign(fresh, new_target_ | !started_);
    loop::HoldState<Term> now{within, holding, held};
    loop::holds_torque<Term>({enter, leave, dwell}, now, fresh, error_);
    write_.assign(within, now.run);
    write_.assign(holding, now.holding);
    // The chain is written first, because it decides what has to be remembered.
    write_.branch(
        !holding,
        [&] {
          write_chain();
          write_.assign(held, u_);
        },
        [&] {
          if (cascade_) {
            if (last_velocity_error_) write_.assign(*last_velocity_error_, velocity_error());
          } else if (last_error_) {
            write_.assign(*last_error_, e_);
          }
          write_.assign(u_, held);
        });
  }

  void write_chain() {
    if (cascade_) {
      write_cascade();
    } else {
      write_pid();
    }
    write_filters();
    write_feedforward();
    write_observer();
  }

  /// Writes the statements that compute d, the filtered difference of successive counts per sample (the
  /// velocity), counts.
  void write_difference() {
    const double pole = loop::derivative_pole(blocks_, sample_rate_);
    const bool remembered = pole != 0.0 || (cascade_ && blocks_.hold.enter >= 0.0);
    difference_ =
        remembered ? state("difference", "of successive counts, filtered, counts") : local("difference");
    const Term a = coefficient("derivative_pole", pole, "of the filter of the difference of counts");
    Term change = difference_of_counts(velocity_count_, last_counts_.front());
    if (last_counts_.size() > 1)
      change = change / write_.constant("derivative_window", blocks_.derivative_window, "samples");
    write_.assign(*difference_, loop::filtered_difference(a, *difference_, change));
  }

  /// Writes the statements that add the increment to the integral I, N m, with its limits, dead band and
  /// zone. Returns the term of I.
  Term write_integral(const Term& increment) {
    const loop::TorqueRange range = loop::integral_range(
        of_.controller.anti_windup, loop::lowest_torque(of_.dac), loop::highest_torque(of_.dac));
    const loop::IntegralConstants<double> c = loop::integral_constants(blocks_, sample_rate_, range);
    const Term integral = state("integral_torque", "I, " + torque_unit_, Type::number, of_.initial_integral);
    const bool has_deadband = c.enter >= 0.0;
    const Term inside = has_deadband
                            ? state("inside", "the error is within the deadband of the integral", Type::flag)
                            : Term(0.0);
    const Term enter = has_deadband
                           ? write_.constant("deadband", c.enter, "in which the integral stays, counts")
                           : Term(c.enter);
    const Term leave = c.leave == c.enter ? enter : write_.constant("deadband_leave", c.leave, "counts");
    const Term zone = coefficient("integrator_zone", c.zone, "counts", unbounded);
    const Term retention = coefficient("retention", c.retention, "of the integral, per sample", 1.0);
    const std::string of_converter = "of the converter, " + torque_unit_;
    const Term lowest = coefficient("lowest_torque", c.lowest, of_converter, -unbounded);
    const Term highest = coefficient("highest_torque", c.highest, of_converter, unbounded);
    loop::IntegralState<Term> now{integral, inside};
    loop::integrate<Term>({enter, leave, zone, retention, lowest, highest}, now, error_, increment);
    if (has_deadband) write_.assign(inside, now.inside);
    write_.assign(integral, now.integral);
    return integral;
  }

  struct SiUnit {
    double factor;  ///< Factor that converts the gain per count to SI units.
    std::string_view unit;
  };

  /// Term of a gain of the PID law, N m/count, which at standstill may have another value; the literal 0 if
  /// it is always 0.
  /// @param usual value of the gain in motion
  /// @param at_standstill value of the gain at standstill
  /// @param si conversion to SI units, for the comment
  Term gain(const std::string& name, std::string_view meaning, double usual, double at_standstill,
            const SiUnit& si) {
    const auto constant = [&](const std::string& of, double value) {
      return coefficient(of, value,
                         fmt::format("{}, {} ({:.6g} {} in SI units)", meaning, torque_per("count"),
                                     value * si.factor, parameters::unit_on(of_.axis, si.unit)));
    };
    const Term one = constant(name, usual);
    if (!stands_now_) return one;
    const Term still = constant("standstill_" + name, at_standstill);
    return is_zero(one) && is_zero(still) ? one : select(*stands_now_, still, one);
  }

  /// Writes the statements that integrate `input` by the trapezoidal rule, I += ki·(input + last input).
  /// Returns the term of I; 0 without an integral.
  /// @param last is set to the state variable that holds the input of the sample before
  Term write_trapezoid(const Term& ki, const Term& input, std::optional<Term>& last, const std::string& name,
                       const std::string& meaning) {
    if (is_zero(ki)) return of_.initial_integral != 0.0 ? write_integral(0.0) : Term(0.0);
    last = state(name, meaning);
    return write_integral(ki * (input + *last));
  }

  void write_pid() {
    write_.remark("PID law");
    const loop::ControllerParameters& c = of_.controller;
    const loop::Standstill& still = blocks_.standstill;
    const double per_radian = 1.0 / of_.resolution;
    const Term ki = gain("ki", "integral gain of the trapezoidal rule", c.ki, still.ki,
                         {2.0 * sample_rate_ * per_radian, "N m/(rad s)"});
    const Term kp = gain("kp", "proportional gain", c.kp, still.kp, {per_radian, "N m/rad"});
    const Term kd = gain("kd", "gain of the difference of successive counts", c.kd, still.kd,
                         {per_radian / sample_rate_, "N m s/rad"});
    if (!last_counts_.empty()) write_difference();
    const Term integral = write_trapezoid(ki, e_, last_error_, "last_error", "of the sample before, counts");
    write_.assign(u_, loop::pid_torque(integral, kp, e_, kd, difference_.value_or(0.0)));
    if (last_error_) write_.assign(*last_error_, e_);
  }

  Term velocity_error() const {
    return loop::velocity_error<Term>({0.0, *velocity_, 0.0, 0.0}, command_, *difference_);
  }

  /// Writes the statements that compute v*, the velocity that the position loop of the cascade commands
  /// (VelocityCommand). They run also at samples whose torque is held.
  void write_command() {
    const loop::CascadeParameters& cascade = blocks_.cascade;
    const loop::CascadeConstants<double> c =
        loop::cascade_constants(cascade, sample_rate_, of_.resolution, of_.velocity_resolution);
    const std::string per_second = angle_unit_ + "/s";
    const Term kv =
        write_.constant("kv", c.kv, fmt::format("{} per count ({:.6g} 1/s)", per_second, cascade.kv));
    Term wanted = kv * e_;
    if (cascade.feedforward != 0.0) {
      const Term forward = write_.constant("command_feedforward", cascade.feedforward, "of the velocity");
      wanted = wanted + forward * write_.input(Input::velocity);
    }
    if (cascade.resolution > 0.0) {
      wanted = loop::rounded_command(wanted, write_.constant("command_step", cascade.resolution, per_second));
    }
    if (cascade.limit < unbounded) {
      const Term limit = write_.constant("command_limit", cascade.limit, per_second);
      wanted = loop::clamped<Term>(wanted, -limit, limit);
    }
    command_ = wanted;
    if (cascade.divider > 1) {
      write_.remark("the position loop runs at one of several samples of the velocity loop");
      command_ = state("command", "of the velocity, " + per_second);
      const Term waits = state("waits", "samples since the position loop ran");
      const Term divider = write_.constant("divider", cascade.divider, "samples of the velocity loop");
      write_.branch(waits < 1.0, [&] { write_.assign(command_, wanted); });
      write_.assign(waits, waits + 1.0);
      write_.branch(waits >= divider, [&] { write_.assign(waits, 0.0); });
    }
    if (cascade.latency == 0) return;
    const std::vector<Term> sent = queue("sent", cascade.latency, per_second);
    const Term arrived = local("arrived");
    write_.assign(arrived, sent.front());
    shift(sent, command_);
    command_ = arrived;
  }

  void write_cascade() {
    write_.remark("position loop around a velocity loop");
    const loop::CascadeConstants<double> c =
        loop::cascade_constants(blocks_.cascade, sample_rate_, of_.resolution, of_.velocity_resolution);
    velocity_ = write_.constant("velocity_per_count", c.velocity,
                                angle_unit_ + "/s per count of difference between samples");
    const std::string unit = parameters::unit_on(of_.axis, "N m s/rad");
    const Term kp = coefficient("kp", c.kp, "of the velocity loop, " + unit);
    const Term ki =
        coefficient("ki", c.ki,
                    fmt::format("of the velocity loop by the trapezoidal rule, {} ({:.6g} {} in SI units)",
                                unit, blocks_.cascade.ki, parameters::unit_on(of_.axis, "N m/rad")));
    write_difference();
    const Term w = local("velocity_error");
    write_.assign(w, velocity_error());
    const Term integral = write_trapezoid(ki, w, last_velocity_error_, "last_velocity_error",
                                          "of the sample before, " + angle_unit_ + "/s");
    write_.assign(u_, loop::cascade_torque(integral, kp, w));
    if (last_velocity_error_) write_.assign(*last_velocity_error_, w);
  }

  void write_filters() {
    if (blocks_.filters.empty()) return;
    const Term x = local("unfiltered");
    for (std::size_t i = 0; i < blocks_.filters.size(); ++i) {
      const loop::BiquadConstants<double> c = loop::discretised(blocks_.filters[i], sample_rate_);
      const std::string name = fmt::format("filter{}", i);
      write_.remark(fmt::format("{}: (b0 + b1/z + b2/z^2)/(1 + a1/z + a2/z^2)", name));
      const auto part = [&](const char* letter, double value) {
        return coefficient(fmt::format("{}_{}", name, letter), value, "of " + name);
      };
      // Also where b0 is 0: a term of its own is the output, which both states read.
      const Term b0 = write_.constant(name + "_b0", c.b0, "of " + name);
      const loop::BiquadConstants<Term> parts{b0, part("b1", c.b1), part("b2", c.b2), part("a1", c.a1),
                                              part("a2", c.a2)};
      const Term first = state(name + "_first", torque_unit_);
      const Term second = state(name + "_second", torque_unit_);
      write_.assign(x, u_);
      loop::BiquadState<Term> after{first, second};
      write_.assign(u_, loop::biquad_step(parts, after, x));
      write_.assign(first, after.s1);
      write_.assign(second, after.s2);
    }
  }

  void write_feedforward() {
    const auto& [velocity, acceleration, friction] = blocks_.feedforward;
    const auto part = [&](const char* name, double value, std::string_view unit) {
      return coefficient(fmt::format("feedforward_{}", name), value, parameters::unit_on(of_.axis, unit));
    };
    const Term added = loop::feedforward_torque<Term>(
        {part("velocity", velocity, "N m s/rad"), part("acceleration", acceleration, "N m s^2/rad"),
         part("friction", friction, "N m")},
        write_.input(Input::velocity), write_.input(Input::acceleration));
    if (is_zero(added)) return;
    write_.remark("feed-forward");
    write_.assign(u_, u_ + added);
  }

  void write_observer() {
    if (!first_count_) return;
    const loop::ObserverConstants<double> c =
        loop::observer_constants(blocks_.observer, sample_rate_, of_.velocity_resolution);
    write_.remark("disturbance observer");
    const Term acceleration = coefficient("observer_inertia", c.acceleration, torque_per("count"));
    const Term q = write_.constant("observer_q", c.q, "gain of its filter");
    const Term a1 = coefficient("observer_a1", c.a1, "of its filter");
    const Term a2 = coefficient("observer_a2", c.a2, "of its filter");
    const Term first = state("observer_first", torque_unit_);
    const Term second = state("observer_second", torque_unit_);
    const Term inertia = local("inertia");
    const Term filtered = local("filtered");
    const Term estimate = local("estimate");
    write_.assign(inertia, acceleration * difference_of_counts(velocity_count_, *first_count_));
    write_.assign(filtered, q * write_.input(Input::torque));
    loop::BiquadState<Term> after{first, second};
    write_.assign(estimate, loop::observer_step<Term>({1.0, 1.0, a1, a2}, after, inertia, filtered));
    write_.assign(first, after.s1);
    write_.assign(second, after.s2);
    write_.assign(u_, u_ - estimate);
  }

  void write_dither() {
    const loop::Dither& dither = of_.controller.dither;
    if (dither.amplitude == 0.0) return;
    write_.remark("dither");
    const Term amplitude = write_.constant("dither_amplitude", dither.amplitude, torque_unit_);
    if (single_) {
      const double step = std::fmod(2.0 * dither.frequency / sample_rate_, 2.0);
      const Term half_periods = write_.constant("dither_step", step, "half periods of the dither per sample");
      const Term phase = state("phase", "of the dither, half periods");
      write_.assign(u_, u_ + select(phase < 1.0, amplitude, -amplitude));
      write_.assign(phase, phase + half_periods);
      write_.branch(phase >= 2.0, [&] { write_.assign(phase, phase - 2.0); });
      return;
    }
    const Term frequency = write_.constant("dither_frequency", dither.frequency, "Hz");
    const Term rate = write_.constant("sample_rate", sample_rate_, "Hz");
    const Term sample = state("sample", "its number, from 0");
    const Term half_periods = local("half_periods");
    write_.assign(half_periods, 2.0 * frequency * sample / rate);
    write_.assign(u_, u_ + select(Term(Operation::is_even, {half_periods}), amplitude, -amplitude));
    write_.assign(sample, sample + 1.0);
  }

  const ControllerToWrite& of_;
  const loop::ControlBlocks& blocks_;
  double sample_rate_;
  bool single_;
  bool cascade_{blocks_.structure == loop::ControlStructure::cascade};
  bool stands_{blocks_.standstill.band >= 0.0 && !cascade_};
  std::string torque_unit_, angle_unit_;
  ProgramWriter write_;

  Term error_{write_.input(Input::error)};
  /// Encoder count from which the velocity is computed, as a difference of successive counts. The disturbance
  /// observer reads it too.
  Term velocity_count_{write_.input(of_.controller.velocity_by_other ? Input::velocity_count : Input::count)};
  Term new_target_{write_.input(Input::new_target)};
  Term e_{error_};  ///< Term of e′, the position error after its dead band, counts.
  Term u_{local("wanted")};
  Term started_{state("started", "there has been a sample", Type::flag)};
  std::vector<Term> last_counts_;  ///< State variables with the counts of earlier samples, the oldest first.
  std::optional<Term> first_count_, difference_, stands_now_;
  /// State variable with the position error of the sample before, for the integral of the PID law.
  std::optional<Term> last_error_;
  Term command_{0.0};  ///< Term of the velocity command of the cascade.
  std::optional<Term> velocity_, last_velocity_error_;
};

}  // namespace

std::string_view why_not_writable(const loop::ControllerParameters& controller, Precision precision) {
  if (controller.user.plugin) return "the controller is a plugin, whose code is its own";
  if (loop::has_coarse_phase(controller)) return "a control with two phases cannot be written yet";
  if (std::max(controller.blocks.derivative_window, controller.blocks.cascade.latency) > max_queue)
    return "a derivative_window or a cascade.latency of more than 64 samples cannot be written yet";
  if (precision == Precision::single_precision && controller.encoder == loop::EncoderChoice::coarse)
    return "a loop closed by the coarse encoder, whose counts are parts of fine ones, cannot be written in "
           "single precision";
  return {};
}

Program chain_program(const ControllerToWrite& chain, Precision precision) {
  return ChainWriter(chain, precision).program();
}

}  // namespace zerocount::controller_code

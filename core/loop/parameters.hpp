#pragma once

#include <array>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/plugin/controller_plugin.hpp"

namespace zerocount::loop {

/// Errors of an encoder. An ideal one has none.
struct EncoderErrors {
  double eccentricity{0.0};        ///< amplitude of the reading's error once per revolution, rad
  double eccentricity_angle{0.0};  ///< angle on the rotor at which that error rises through zero, rad
  double interpolation{0.0};       ///< amplitude of the error once per signal period, counts of this encoder
  double interpolation_period{4.0};  ///< signal period, counts of this encoder
  double noise{
      0.0};  ///< standard deviation of the reading before it is rounded to a count, counts of this encoder
  double missed{0.0};  ///< probability that a count that is passed is not counted, in [0, 1]
  /// −3 dB bandwidth of the noise, a first-order process, Hz; infinite: white, drawn anew at each sample.
  double noise_bandwidth{std::numeric_limits<double>::infinity()};
};

/// An encoder that reads the other of two masses than the one that closes the (position) loop.
struct OtherEncoder {
  double counts{0.0};  ///< in `length`, a whole number; 0: there is no such encoder
  double length{0.0};  ///< rad, or m
  EncoderErrors errors{};
};

/// The encoders: Δx = length/counts. On a rotary axis `fine` and `coarse` are the counts of a revolution,
/// 2π rad; on a linear axis one count has the length of the resolution. Defaults: the paper's machine.
struct EncoderParameters {
  double fine{1620000.0};  ///< counts in `fine_length` of the encoder that closes the loop, a whole number
  double coarse{86400.0};  ///< counts in `coarse_length` of the encoder read beside it, a whole number
  double fine_length{2.0 * std::numbers::pi};    ///< rad, or m
  double coarse_length{2.0 * std::numbers::pi};  ///< rad, or m
  EncoderErrors fine_errors{};
  EncoderErrors coarse_errors{};
  OtherEncoder other{};
};

/// The digital-to-analogue converter. Defaults: the paper's machine.
struct DacParameters {
  int bits{12};               ///< word length, codes −2^(bits−1) … 2^(bits−1) − 1
  double resolution{2.4e-4};  ///< Δu, torque of one code, N m
  double offset{0.0};         ///< added to the torque of every code, N m
  double gain_error{0.0};     ///< relative error of Δu, dimensionless
  double nonlinearity{
      0.0};  ///< integral non-linearity: largest deviation from the straight line between the ends, codes
  double noise{0.0};        ///< standard deviation of the torque, drawn anew at each sample, N m
  bool sigma_delta{false};  ///< the rounding error of a sample is added to the next torque (Converter)
  /// Of the amplifier's torque, to which the wanted torque is clipped, N m.
  double limit{std::numeric_limits<double>::infinity()};
};

/// The amplifier between converter and motor.
struct AmplifierParameters {
  double bandwidth{0.0};  ///< of its first-order response (−3 dB), Hz; 0: without lag
};

enum class AntiWindup { clamp, none };

enum class EncoderChoice { fine, coarse };

/// Phase of a two-phase control. A control without a coarse phase is always in the fine one.
enum class ControlPhase { fine, coarse };

/// Errors at which the integral stays as it is. Inside from a sample with |e| ≤ enter on, until one with |e|
/// > max(enter, leave). Negative bounds: none.
struct Deadband {
  double enter{-1.0};  ///< counts
  double leave{-1.0};  ///< counts; below `enter` it counts as `enter`
};

enum class DeadbandForm {
  zero,     ///< e′ = 0 where |e| ≤ band, else e
  subtract  ///< e′ = 0 where |e| ≤ band, else e − band·sgn(e)
};

/// A dead zone of the error: e′ stands for e in the control law.
struct ErrorDeadband {
  double band{-1.0};  ///< counts; negative: none
  DeadbandForm form{DeadbandForm::zero};
};

/// Holds the wanted torque at standstill (torque_hold.hpp).
struct Hold {
  double enter{-1.0};  ///< |error| that must have lasted for `dwell`, counts; negative: never
  double leave{-1.0};  ///< |error| beyond which the hold ends, counts; below `enter` it counts as `enter`
  double dwell{0.0};   ///< s, at least one sample
};

/// Gains of the PID law at standstill (pid.hpp).
struct Standstill {
  double band{-1.0};  ///< largest |error|, counts; negative: never
  double dwell{0.0};  ///< for which it must have lasted, s, at least one sample
  double kp{0.0};     ///< N m/count
  double ki{0.0};     ///< of the trapezoidal rule, N m/count
  double kd{0.0};     ///< on the difference of successive counts, N m/count
};

/// A square wave on the wanted torque (dither_torque).
struct Dither {
  double amplitude{0.0};    ///< N m
  double frequency{500.0};  ///< Hz
};

enum class FilterKind { lowpass, notch, lead, biquad };

/// One element of the filters (filter.hpp), with the values that its kind uses.
struct Filter {
  FilterKind kind{FilterKind::lowpass};
  double frequency{100.0};           ///< ω0/2π of lowpass, notch and lead, Hz
  double damping{0.7};               ///< ζ of lowpass and notch, dimensionless
  double depth{0.1};                 ///< gain of a notch at its frequency, dimensionless
  double ratio{3.0};                 ///< of a lead: its pole over its zero, dimensionless
  std::array<double, 3> b{1, 0, 0};  ///< b₀, b₁, b₂ of a biquad
  std::array<double, 2> a{0, 0};     ///< a₁, a₂ of a biquad
};

/// Torque from the motion of the reference (feedforward.hpp).
struct FeedforwardParameters {
  double velocity{0.0};      ///< N m s/rad
  double acceleration{0.0};  ///< N m s²/rad
  double friction{0.0};      ///< N m
};

/// Disturbance observer (disturbance_observer.hpp).
struct ObserverParameters {
  double bandwidth{0.0};    ///< Hz; 0: without observer
  double inertia{5.54e-4};  ///< Jn, of the observer's model of the rotor, kg m²
};

enum class ControlStructure {
  pid,     ///< kp, ki and kd act on the error (pid.hpp)
  cascade  ///< a position loop around a velocity loop (cascade.hpp)
};

/// The mass whose encoder a loop of the cascade reads.
enum class LoopEncoder {
  of_the_plant,  ///< motion::LoadParameters::encoder
  motor,
  load
};

/// The cascade, and the way of its velocity command from the position loop to the velocity loop.
struct CascadeParameters {
  double kv{150.0};         ///< of the position loop: velocity command per error, 1/s
  double kp{0.4};           ///< of the velocity loop, N m s/rad
  double ki{60.0};          ///< of the velocity loop, N m/rad
  double feedforward{0.0};  ///< of the reference's velocity into the command, dimensionless
  int divider{1};           ///< samples of the velocity loop in one of the position loop
  int latency{0};           ///< after which a command acts, samples of the velocity loop
  double resolution{0.0};   ///< of the command, rad/s; 0: none
  double limit{std::numeric_limits<double>::infinity()};  ///< of |command|, rad/s
  LoopEncoder position{LoopEncoder::of_the_plant};
  LoopEncoder velocity{LoopEncoder::of_the_plant};
};

/// Blocks of the controller besides the PID gains. By default none acts.
struct ControlBlocks {
  ControlStructure structure{ControlStructure::pid};
  CascadeParameters cascade{};
  Deadband deadband{};
  /// The integral changes only where |e| is not larger, counts.
  double integrator_zone{std::numeric_limits<double>::infinity()};
  /// Time constant with which the integral decays, s.
  double integrator_leak{std::numeric_limits<double>::infinity()};
  int derivative_window{1};  ///< samples between the counts whose difference is taken
  /// Cutoff of the low-pass filter on the difference of counts, Hz.
  double derivative_cutoff{std::numeric_limits<double>::infinity()};
  std::vector<Filter> filters{};  ///< in the order in which they act
  FeedforwardParameters feedforward{};
  ObserverParameters observer{};
  ErrorDeadband error_deadband{};
  Hold hold{};
  Standstill standstill{};
};

/// Two-phase (dual mode) control (paper, end of section 2): the gains of the coarse phase, and when it is
/// left and entered. All counts are fine ones; a phase that is fed back from the coarse encoder has that
/// one's count times fine/coarse.
struct CoarsePhaseParameters {
  double kp{5.0e-4};                           ///< N m/count
  double ki{2.0e-6};                           ///< of the trapezoidal rule, N m/count
  double kd{6.0e-3};                           ///< on the difference of successive counts, N m/count
  EncoderChoice encoder{EncoderChoice::fine};  ///< that closes the loop in the coarse phase
  double fine_within{100.0};  ///< largest |error| with which the fine phase is entered, counts
  double fine_rate{1.0};      ///< largest change of the count per sample with which it is entered, counts
  double fine_dwell{0.01};    ///< time for which both must have held, s
  /// |error| beyond which the coarse phase is entered, counts; by default never.
  double coarse_beyond{std::numeric_limits<double>::infinity()};
  ControlBlocks blocks{};  ///< of the coarse phase
};

/// A control law of the user's own in place of kp, ki and kd (user_law.hpp).
struct UserControl {
  std::shared_ptr<const plugin::ControllerPlugin> plugin{};  ///< null: none
  std::vector<double> parameters{};                          ///< in the order of its description
};

/// Control of the count.
struct ControllerParameters {
  double sample_rate{2000.0};  ///< 1/T, Hz
  double kp{0.0};              ///< N m/count
  double ki{3.85e-5};          ///< k_ID = k_I·Δx·T/2 of the trapezoidal rule, N m/count
  double kd{0.0};              ///< on the difference of successive counts, N m/count
  double delay{0.0};           ///< samples between deciding a torque and applying it, whole or not
  AntiWindup anti_windup{AntiWindup::clamp};
  EncoderChoice encoder{EncoderChoice::fine};  ///< that closes the loop in the fine phase
  CoarsePhaseParameters coarse{};
  ControlBlocks blocks{};         ///< with a coarse phase those of the fine one
  bool velocity_by_other{false};  ///< the velocity loop of a cascade reads EncoderParameters::other
  UserControl user{};
  Dither dither{};
  double missed{0.0};  ///< probability that the controller does not run at a sample, in [0, 1)
  /// Each sample is late by a time drawn evenly from [0, jitter), s; below 1/sample_rate.
  double jitter{0.0};
};

enum class ReferenceShape {
  step,         ///< the reference is the target from the first sample of the move
  trapezoidal,  ///< velocity rises and falls linearly
  s_curve,      ///< so does the acceleration
  sine,         ///< the reference oscillates about the target, from the first sample of the move
  record        ///< the reference follows a record, from the first sample of the move
};

/// Whether the reference reaches no target: what is judged is how it is followed.
constexpr bool moves_for_ever(ReferenceShape shape) {
  return shape == ReferenceShape::sine || shape == ReferenceShape::record;
}

/// A recorded path of the reference, straight between its rows.
struct ReferenceRecord {
  std::vector<double> time;      ///< s, increasing, at least two rows, the first at 0
  std::vector<double> position;  ///< [time], rad
};

/// Path of the reference from one target to the next, or about the target.
struct ReferenceProfile {
  ReferenceShape shape{ReferenceShape::step};
  double velocity_limit{2.0};        ///< rad/s
  double acceleration_limit{100.0};  ///< rad/s²
  double jerk_limit{1.0e4};          ///< of an s_curve: limit of the rate of the acceleration, rad/s³
  double amplitude{1.0e-3};          ///< of a sine, rad
  double frequency{1.0};             ///< of a sine, Hz
  std::shared_ptr<const ReferenceRecord> record{};  ///< of a record
};

}  // namespace zerocount::loop

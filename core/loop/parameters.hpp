#pragma once

#include <array>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/plugin/controller_plugin.hpp"

namespace zerocount::loop {

/// Errors of an encoder. The defaults are those of an ideal encoder, which has none.
struct EncoderErrors {
  double eccentricity{0.0};  ///< Amplitude of the reading's error once per revolution, rad
  /// Angle on the rotor at which the reading's error by eccentricity rises through zero, rad
  double eccentricity_angle{0.0};
  double interpolation{0.0};  ///< Amplitude of the interpolation error, which repeats once per signal period,
                              ///< counts of this encoder
  double interpolation_period{4.0};  ///< Signal period of the interpolation error, counts of this encoder
  /// Standard deviation of the reading before it is rounded to a count, counts of this encoder
  double noise{0.0};
  double missed{0.0};  ///< Probability that a passed count is not counted, in [0, 1]
  /// −3 dB bandwidth of the noise, a first-order process, Hz; infinite: white noise, independent from sample
  /// to sample.
  double noise_bandwidth{std::numeric_limits<double>::infinity()};
};

/// Parameters of the encoder on the other mass, the one that does not close the position loop.
struct OtherEncoder {
  double counts{0.0};  ///< Number of counts in `length`, a whole number; 0 without such an encoder
  double length{0.0};  ///< Length that these counts cover, rad, or m on a linear axis
  EncoderErrors errors{};
};

/// Parameters of the encoders; the resolution of each is Δx = length/counts. On a rotary axis `fine` and
/// `coarse` are the counts of a revolution, 2π rad; on a linear axis one count has the length of the
/// resolution. The defaults are those of the paper's machine.
struct EncoderParameters {
  double fine{1620000.0};  ///< Number of counts, in `fine_length`, of the encoder that closes the loop; a
                           ///< whole number
  /// Number of counts, in `coarse_length`, of the coarse encoder that is read beside the fine one; a whole
  /// number
  double coarse{86400.0};
  /// Length that the fine counts cover, rad, or m on a linear axis
  double fine_length{2.0 * std::numbers::pi};
  /// Length that the coarse counts cover, rad, or m on a linear axis
  double coarse_length{2.0 * std::numbers::pi};
  EncoderErrors fine_errors{};
  EncoderErrors coarse_errors{};
  OtherEncoder other{};
};

/// Parameters of the digital-to-analogue converter. The defaults are those of the paper's machine.
struct DacParameters {
  int bits{12};               ///< Word length, bits; the codes are −2^(bits−1) … 2^(bits−1) − 1
  double resolution{2.4e-4};  ///< Torque Δu of one code, N m
  double offset{0.0};         ///< Torque added to the output of every code, N m
  double gain_error{0.0};     ///< Relative error of the torque per code Δu, dimensionless
  /// Integral non-linearity: largest deviation from the straight line between the ends, codes
  double nonlinearity{0.0};
  double noise{0.0};        ///< Standard deviation of the torque, drawn anew at each sample, N m
  bool sigma_delta{false};  ///< Whether the rounding error of a sample is added to the next torque
                            ///< (sigma-delta, see Converter)
  /// Limit of the amplifier's torque, to which the wanted torque is clipped, N m.
  double limit{std::numeric_limits<double>::infinity()};
};

/// Parameters of the amplifier between digital-to-analogue converter and motor.
struct AmplifierParameters {
  double bandwidth{0.0};  ///< Bandwidth of the first-order response (−3 dB), Hz; 0: without lag
};

enum class AntiWindup { clamp, none };

enum class EncoderChoice { fine, coarse };

/// Phase of a two-phase control. A control without a coarse phase is always in the fine one.
enum class ControlPhase { fine, coarse };

/// Deadband of the integral: errors at which the integral stays as it is. The deadband begins at a sample
/// with |e| ≤ enter, and lasts until a sample with |e| > max(enter, leave). Negative bounds: no deadband.
struct Deadband {
  double enter{-1.0};  ///< Largest |e| that starts the deadband, counts; negative: no deadband
  double leave{-1.0};  ///< Largest |e| that keeps the deadband, counts; below `enter` it counts as `enter`
};

enum class DeadbandForm {
  zero,     ///< Dead zone with a jump at its edge: e′ = 0 if |e| ≤ band, otherwise e′ = e
  subtract  ///< Continuous dead zone: e′ = 0 if |e| ≤ band, otherwise e′ = e − band·sgn(e)
};

/// A dead zone of the error: the control law uses e′ in place of the error e.
struct ErrorDeadband {
  double band{-1.0};  ///< Half width of the dead zone, counts; negative: no dead zone
  DeadbandForm form{DeadbandForm::zero};
};

/// Hold of the wanted torque at standstill, when and how long (torque_hold.hpp).
struct Hold {
  double enter{-1.0};  ///< Largest |error| that, if it lasts for `dwell`, starts the hold, counts; negative:
                       ///< never
  double leave{-1.0};  ///< |error| beyond which the hold ends, counts; below `enter` it counts as `enter`
  double dwell{0.0};   ///< Time for which |error| ≤ enter must have lasted, s; at least one sample
};

/// Gains of the PID law that act at standstill, and the conditions for it (pid.hpp).
struct Standstill {
  double band{-1.0};  ///< Largest |error| at standstill, counts; negative: never
  double dwell{0.0};  ///< Time for which |error| ≤ band must have lasted, s; at least one sample
  double kp{0.0};     ///< Proportional gain at standstill, N m/count
  double ki{0.0};     ///< Integral gain of the trapezoidal rule at standstill, N m/count
  double kd{0.0};     ///< Gain on the difference of successive counts at standstill, N m/count
};

/// A square wave that is added to the wanted torque (dither_torque).
struct Dither {
  double amplitude{0.0};    ///< Amplitude of the square wave, N m
  double frequency{500.0};  ///< Frequency of the square wave, Hz
};

enum class FilterKind { lowpass, notch, lead, biquad };

/// One of the controller's filters (filter.hpp). Which values it uses depends on its kind.
struct Filter {
  FilterKind kind{FilterKind::lowpass};
  double frequency{100.0};           ///< Frequency ω0/2π of a lowpass, notch or lead, Hz
  double damping{0.7};               ///< Damping ratio ζ of a lowpass or notch, dimensionless
  double depth{0.1};                 ///< Gain of a notch at its frequency, dimensionless
  double ratio{3.0};                 ///< Ratio of a lead: its pole divided by its zero, dimensionless
  std::array<double, 3> b{1, 0, 0};  ///< Numerator coefficients b₀, b₁, b₂ of a biquad
  std::array<double, 2> a{0, 0};     ///< Denominator coefficients a₁, a₂ of a biquad
};

/// Feed-forward torque from the motion of the reference (feedforward.hpp).
struct FeedforwardParameters {
  double velocity{0.0};      ///< Feed-forward torque per velocity of the reference, N m s/rad
  double acceleration{0.0};  ///< Feed-forward torque per acceleration of the reference, N m s²/rad
  double friction{0.0};      ///< Feed-forward torque in the direction of the reference's velocity, N m
};

/// Parameters of the disturbance observer (disturbance_observer.hpp).
struct ObserverParameters {
  double bandwidth{0.0};    ///< Bandwidth of the observer, Hz; 0: without observer
  double inertia{5.54e-4};  ///< Inertia Jn of the rotor in the observer's model, kg m²
};

enum class ControlStructure {
  pid,     ///< PID law: kp, ki and kd act on the error (pid.hpp)
  cascade  ///< Position loop around a velocity loop (cascade.hpp)
};

/// Selects the mass whose encoder the position loop or the velocity loop of a cascade reads.
enum class LoopEncoder {
  of_the_plant,  ///< The mass that motion::LoadParameters::encoder selects, whose encoder closes the position
                 ///< loop
  motor,
  load
};

/// Parameters of the cascade, and of the transmission of its velocity command from the position loop to the
/// velocity loop.
struct CascadeParameters {
  double kv{150.0};         ///< Gain of the position loop: velocity command per error, 1/s
  double kp{0.4};           ///< Proportional gain of the velocity loop, N m s/rad
  double ki{60.0};          ///< Integral gain of the velocity loop, N m/rad
  double feedforward{0.0};  ///< Gain from the reference's velocity to the velocity command, dimensionless
  int divider{1};           ///< Samples of the velocity loop per sample of the position loop
  int latency{0};           ///< Delay of the velocity command, samples of the velocity loop
  double resolution{0.0};   ///< Resolution of the velocity command, rad/s; 0: not rounded
  double limit{std::numeric_limits<double>::infinity()};  ///< Limit of the absolute velocity command of the
                                                          ///< position loop, rad/s
  LoopEncoder position{LoopEncoder::of_the_plant};
  LoopEncoder velocity{LoopEncoder::of_the_plant};
};

/// Parameters of the controller's blocks besides the PID gains. By default none of the blocks acts.
struct ControlBlocks {
  ControlStructure structure{ControlStructure::pid};
  CascadeParameters cascade{};
  Deadband deadband{};
  /// Largest absolute error |e| at which the integral changes, counts; infinite: it always changes.
  double integrator_zone{std::numeric_limits<double>::infinity()};
  /// Time constant with which the integral decays (leak), s; infinite: no leak.
  double integrator_leak{std::numeric_limits<double>::infinity()};
  int derivative_window{1};  ///< Number of samples between the two counts whose difference the derivative
                             ///< uses
  /// Cutoff frequency of the low-pass filter on the difference of counts, Hz; infinite: no filter.
  double derivative_cutoff{std::numeric_limits<double>::infinity()};
  std::vector<Filter> filters{};  ///< Filters of the torque, in the order in which they act
  FeedforwardParameters feedforward{};
  ObserverParameters observer{};
  ErrorDeadband error_deadband{};
  Hold hold{};
  Standstill standstill{};
};

/// Two-phase (dual mode) control (paper, end of section 2): gains of the coarse phase, and conditions for
/// leaving and entering it. All values in counts are in counts of the fine encoder: a phase that is fed back
/// from the coarse encoder converts that encoder's count first, by the ratio of the two resolutions.
struct CoarsePhaseParameters {
  double kp{5.0e-4};                           ///< Proportional gain in the coarse phase, N m/count
  double ki{2.0e-6};                           ///< Integral gain of the trapezoidal rule in the coarse phase,
                                               ///< N m/count
  double kd{6.0e-3};                           ///< Gain on the difference of successive counts in the coarse
                                               ///< phase, N m/count
  EncoderChoice encoder{EncoderChoice::fine};  ///< Encoder that closes the loop in the coarse phase
  double fine_within{100.0};                   ///< Largest |error| at which the fine phase may be entered,
                                               ///< counts
  double fine_rate{1.0};    ///< Largest change of the count per sample at which the fine phase may be
                            ///< entered, counts
  double fine_dwell{0.01};  ///< Time for which `fine_within` and `fine_rate` must have held, s
  /// |error| beyond which the coarse phase is entered, counts. By default it is never entered.
  double coarse_beyond{std::numeric_limits<double>::infinity()};
  ControlBlocks blocks{};  ///< Blocks of the controller in the coarse phase
};

/// A control law of the user's own, from a plugin, in place of kp, ki and kd (user_law.hpp).
struct UserControl {
  /// Plugin that computes the torque; null: the control law is the PID law with kp, ki and kd, or a cascade.
  std::shared_ptr<const plugin::ControllerPlugin> plugin{};
  std::vector<double> parameters{};  ///< Values of the plugin's parameters, in the order of its description
};

/// Parameters of the controller: sample rate, gains and blocks.
struct ControllerParameters {
  double sample_rate{2000.0};  ///< Sample rate 1/T, Hz
  double kp{0.0};              ///< Proportional gain, N m/count
  double ki{3.85e-5};          ///< Gain k_ID = k_I·Δx·T/2 of the trapezoidal rule, N m/count
  double kd{0.0};              ///< Gain on the difference of successive counts, N m/count
  double delay{0.0};  ///< Samples between deciding a torque and applying it, not necessarily a whole number.
  AntiWindup anti_windup{AntiWindup::clamp};
  EncoderChoice encoder{EncoderChoice::fine};  ///< Encoder that closes the loop; in a two-phase control, the
                                               ///< encoder of the fine phase
  CoarsePhaseParameters coarse{};
  ControlBlocks blocks{};         ///< Blocks of the controller; in a two-phase control, blocks of the fine
                                  ///< phase
  bool velocity_by_other{false};  ///< Whether the velocity loop of a cascade reads the encoder on the other
                                  ///< mass, EncoderParameters::other
  UserControl user{};
  Dither dither{};
  double missed{0.0};  ///< Probability that the controller does not run at a sample, in [0, 1)
  /// Largest lateness of a sample, s, below 1/sample_rate. Each sample is late by a time drawn evenly from
  /// [0, jitter).
  double jitter{0.0};
};

enum class ReferenceShape {
  step,         ///< The reference is the target from the first sample of the move.
  trapezoidal,  ///< Trapezoidal velocity profile: the velocity rises and falls linearly.
  s_curve,      ///< Velocity profile with limited jerk: the acceleration rises and falls linearly.
  sine,         ///< The reference oscillates about the target from the first sample of the move.
  record        ///< The reference follows a record from the first sample of the move.
};

/// Whether a reference of this shape never comes to rest at a target (sine or record). The tracking of such a
/// reference is judged.
constexpr bool moves_for_ever(ReferenceShape shape) {
  return shape == ReferenceShape::sine || shape == ReferenceShape::record;
}

/// A recorded path of the reference over time, interpolated linearly between its rows.
struct ReferenceRecord {
  std::vector<double> time;      ///< Times of the rows, s: increasing, at least two, the first one 0
  std::vector<double> position;  ///< Position of the reference in each row, rad
};

/// Path of the reference from one target to the next, or about the target, and its limits.
struct ReferenceProfile {
  ReferenceShape shape{ReferenceShape::step};
  double velocity_limit{2.0};        ///< Limit of the reference's velocity, rad/s
  double acceleration_limit{100.0};  ///< Limit of the reference's acceleration, rad/s²
  double jerk_limit{1.0e4};          ///< Limit of the rate of the acceleration of an s_curve, rad/s³
  double amplitude{1.0e-3};          ///< Amplitude of a sinusoidal reference, rad
  double frequency{1.0};             ///< Frequency of a sinusoidal reference, Hz
  /// Recorded path of the reference, for the shape `record`; null for other shapes.
  std::shared_ptr<const ReferenceRecord> record{};
};

}  // namespace zerocount::loop

#pragma once

#include "core/batch/kernels/lane_set.hpp"
#include "core/friction/presliding/presliding_formulas.hpp"
#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/formulas.hpp"
#include "core/trial/running_measures.hpp"

/// State of all trials that a batch engine runs side by side. Each lane, a slot of the engine, runs one
/// trial. Every quantity is an array with one number per lane, so that a vector instruction processes the
/// same quantity of several lanes. Flags are 0 or 1; whole numbers are stored as exact doubles.
///
/// Included by the kernels: see simd.hpp for what must not be in here.
namespace zerocount::batch {

/// Number of elements of an array with one number per lane: the lanes, and at least one spare lane that fills
/// up incomplete vectors. The spare lane's contents affect no other lane. Rounded up to a cache line.
inline constexpr int lane_slots = max_lanes + 8;
inline constexpr int spare_lane = max_lanes;

inline constexpr int batch_order = 14;  ///< Order of the Taylor series of an integration step
/// Largest number of steps of a lane since its last sample. With more, the scalar reference engine takes the
/// lane over.
inline constexpr double max_steps_to_stop = 500.0;

using Lanes = double[lane_slots];

/// State of motion of the rotor and of its friction contact.
struct alignas(64) MotionLanes {
  Lanes elongation;  ///< Elongation xs of the contact's spring, or deflection z of the bristle, rad
  Lanes omega;       ///< Velocity ω of the rotor, rad/s
  Lanes extension;   ///< Plastic extension xp of the contact by creep, rad
  Lanes hardening;   ///< Hardening xh of the contact by creep, rad
  Lanes torque;      ///< Torque on the rotor, without friction, at this instant, N m
  Lanes hook;        ///< Position of the hook, the end of the friction spring that sticks to the ground, rad
  Lanes theta;       ///< Rotor angle θ while the hook slides, rad; always valid for friction laws without a
                     ///< hook

  Lanes branch_elongation;        ///< Elongation xr at which the spring's present hysteresis branch begins,
                                  ///< rad
  Lanes branch_torque;            ///< Spring torque σr at which the present hysteresis branch begins, N m
  Lanes branch_sign;              ///< Side s of xr on which the present hysteresis branch lies: −1 or 1
  Lanes branch_softening_torque;  ///< Softening torque of the present hysteresis branch, N m (see
                                  ///< SpringBranchOf)
  Lanes branch_softening_rate;    ///< Softening rate of the present hysteresis branch, 1/rad (see
                                  ///< SpringBranchOf)
  Lanes branch_softening_length;  ///< Softening length of the present hysteresis branch,
                                  ///< 1/branch_softening_rate, rad
  Lanes branch_end;   ///< Elongation at which the present hysteresis branch ends in the present direction,
                      ///< rad; ±infinity without an end
  Lanes direction;    ///< Direction in which the spring's elongation moves on the present hysteresis
                      ///< branch: −1, 0, 1
  Lanes heading;      ///< Direction in which the spring's elongation moves from this instant on: −1, 0, 1
  Lanes at_reversal;  ///< 1 if the rate dxs/dt of the spring's elongation is zero at this instant
  Lanes creeping;     ///< 1 while the contact creeps
  Lanes creep_onset;  ///< |σ|, the absolute spring torque, at which creep sets in, N m
  Lanes slide_direction;  ///< Direction in which the hook slides, −1 or 1; 0 while it sticks. Always 1 for
                          ///< friction laws without a hook, where `theta` holds the rotor angle.
  Lanes gradual_slide;    ///< 1 if, at this instant, the bristle slides or all Maxwell-slip elements slip
  Lanes rest_torque;      ///< Motor torque under which the rotor is at rest, N m; NaN while it moves

  Lanes spring_torque;  ///< Spring torque σ at the start of the step, N m
  Lanes torque_power;   ///< Power |σ|ⁿ of the spring torque in the creep law, at the start of the step
  Lanes softness;  ///< Exponential exp(−y) of the hysteresis branch's softening at the start of the step
};

/// Parameters of rotor and friction that are constant from one re-stick of the contact to its next slip.
struct alignas(64) ContactLanes {
  Lanes inertia;          ///< Inertia J of the rotor, kg m²
  Lanes per_inertia;      ///< Reciprocal inertia 1/J, 1/(kg m²)
  Lanes damping;          ///< Viscous damping c between hook and rotor while the hook sticks, N m s/rad
  Lanes sliding_damping;  ///< Viscous damping cs while the hook slides, or damping d of a bristle law, N m
                          ///< s/rad
  Lanes k1;               ///< Lowest tangent stiffness k1 of the contact's spring, N m/rad
  Lanes stiffest;         ///< Highest tangent stiffness k1 + k2 of the contact's spring, N m/rad
  Lanes alpha;            ///< Rate α of creep, 1/s
  Lanes per_lambda;       ///< Reciprocal 1/λ of the hardening modulus of creep, rad/(N m)ⁿ
  Lanes max_creep_ratio;  ///< Bound 8αc/k1 of the contribution of creep to dxs/dt, the rate of the spring's
                          ///< elongation, relative to the rate dxp/dt of creep
  Lanes creep_exponent;   ///< Exponent n of the torque in the creep law
  Lanes breakaway;        ///< Breakaway torque Fs, N m
  Lanes coulomb;          ///< Coulomb torque Fc, N m
  Lanes per_velocity_squared;  ///< 1/ωs², with ωs the Stribeck velocity, s²/rad²
  Lanes fast_velocity;         ///< 8ωs, rad/s: at a higher velocity the sliding friction equals Coulomb
                               ///< friction
  Lanes max_oscillation;       ///< Largest amplitude of an oscillation that may count as rest at a reversal
                               ///< of the elongation, rad
  Lanes bristle_stiffness;     ///< Stiffness σ0 of the bristle, N m/rad
  Lanes bristle_damping;       ///< Damping σ1 of the bristle, N m s/rad
  Lanes spent;                 ///< 1 if a slide has just ended where it began (StandingContact::spent)
};

/// Exact map of the motion without dry friction over one sample, under the torque u + l·exp(−rt), u constant
/// and l a decaying lag: θ ← θ + travel·ω + push·u + lag_push·l, ω ← decay·ω + gain·u + lag_gain·l.
struct alignas(64) FreeLanes {
  Lanes travel;    ///< Change of θ per initial velocity ω, s
  Lanes push;      ///< Change of θ per constant torque u, rad/(N m)
  Lanes decay;     ///< Factor by which ω decays within the sample, dimensionless
  Lanes gain;      ///< Change of ω per constant torque u, rad/(N m s)
  Lanes lag_push;  ///< Change of θ per decaying torque l, rad/(N m)
  Lanes lag_gain;  ///< Change of ω per decaying torque l, rad/(N m s)
};

/// Description of the slow motion over some samples ahead, by cubic polynomials, for a lane whose rotor is at
/// rest but creeps, and which must stop at every sample. Only lanes in LaneStates::ahead use it; the scalar
/// plant of such a lane stays at the start of the description.
struct alignas(64) CreepAheadLanes {
  Lanes elapsed;   ///< Time since the start of the description, by which the plant lags behind the lane, s
  Lanes duration;  ///< Time that the description covers, s; 0 if there is no description
  // Without the oscillation, coefficients in elapsed/duration, rad.
  Lanes elongation[4];
  Lanes extension[4];
  Lanes hardening[4];
  friction::OscillationConstants<Lanes> oscillation;
  Lanes oscillation_end;  ///< Time at which the residual oscillation counts as ended, on its own time axis, s
  Lanes start;            ///< Start of the description on the time axis of the oscillation, s
  Lanes creep_sign;       ///< Sign of the spring torque, sgn(σ)
};

/// Time within the sample, and length of the integration steps, of each lane.
struct alignas(64) TimeLanes {
  Lanes time_to_stop;     ///< Time to the lane's next stop, s: the next instant at which its torque may
                          ///< change or its encoder must be read
  Lanes samples_to_stop;  ///< Number of samples to the lane's next stop, including the one at the stop
  Lanes time_scale;       ///< 1/ωn with ωn² = (k1 + k2)/J, the highest natural frequency of the contact, s
  Lanes next_step;        ///< Length of the next integration step that is expected to be accurate enough, s
  Lanes steps;            ///< Number of integration steps tried since the last sample
  Lanes sample_time;      ///< Sample time T, s
  Lanes sample_rate;      ///< Sample rate 1/T, Hz
  Lanes tolerance;        ///< Truncation error of the motion allowed per sample time, rad
  Lanes per_count;        ///< Reciprocal 1/Δx of the fine encoder's resolution, counts/rad
  Lanes rest;             ///< Amplitude of an oscillation below which the rotor counts as at rest, rad
};

/// Encoder, PID controller and digital-to-analogue converter.
struct alignas(64) LoopLanes {
  Lanes resolution;  ///< Resolution Δx of the fine encoder, rad per count
  Lanes phase;
  Lanes kp, ki, kd;                         ///< Gains of the PID law, N m/count
  Lanes lowest_integral, highest_integral;  ///< Range to which anti-windup clamps the integral, N m
  Lanes dac_resolution;                     ///< Torque Δu of one code of the converter, N m
  Lanes lowest_code, highest_code;
  Lanes target;    ///< Target of the present move, counts
  Lanes integral;  ///< Integral I of the PID law, N m
  Lanes error;     ///< Error (target − count) at the last sample, counts
  Lanes count;     ///< Count of the fine encoder at the last sample; before the first sample, the
                   ///< difference n_{−1} − n_0 of counts
  Lanes quiet_from;  ///< Lower bound of θ/Δx + phase − count, the rotor's position within the present count,
                     ///< between which and quiet_to samples can be passed over because nothing measured
                     ///< changes, counts
  Lanes quiet_to;  ///< Upper bound of θ/Δx + phase − count, the rotor's position within the present count, up
                   ///< to which samples can be passed over because nothing measured changes, counts. The
                   ///< bounds are 0 and 1 if only the encoder's reading is measured, and infinite if not even
                   ///< that is.
  Lanes counted;      ///< 1 once the trial has had its first sample
  Lanes decided;      ///< Torque that the controller decided at the last sample, N m
  Lanes converted;    ///< Output of the converter for the decided torque, N m; given by the LaneLoop if the
                      ///< lane has one
  Lanes code;         ///< Code of the converter at the last sample
  Lanes steady;       ///< 1 if the torque will stay as it is as long as the encoder's count does
  Lanes driven;       ///< 1 if a LaneDrive (delay, amplifier, disturbance) lies between the decided torque
                      ///< and the rotor
  Lanes disturbance;  ///< Constant torque on the rotor besides the motor's, N m
  Lanes read_twist;  ///< Rotor angle θ minus the load's angle, rad, if the encoder reads the load; otherwise
                     ///< 0
  // Results of the LaneLoop at this sample. Lanes without a LaneLoop do not use them.
  Lanes given_count;
  Lanes given_code;
  Lanes given_decided;  ///< Torque that the LaneLoop decided at this sample, N m
  Lanes given_clipped;  ///< 1 if the torque that the LaneLoop decided was beyond the converter's range
  Lanes given_may_stay;
  Lanes given_stays;  ///< 1 if the torque that the LaneLoop decided stays whatever the count is
};

/// One stream of counter-based random numbers (random::random_bits_at) of each lane; its key and counters are
/// stored as whole numbers below 2³².
struct RandomLanes {
  Lanes trial_low, trial_high;
  Lanes stream;
  Lanes key[2];
};

/// Noise of the fine encoder, and the coarse encoder that is read beside it. Lanes without encoder noise do
/// not use it.
struct alignas(64) NoiseLanes {
  RandomLanes random;
  loop::NoiseConstants<Lanes> constants;
  Lanes sample;             ///< Number k of the next sample, counted from the start of the trial
  Lanes state;              ///< Value w of the encoder's noise at the last sample, in standard deviations
  Lanes coarse_resolution;  ///< Resolution of the coarse encoder, rad per count
  Lanes disagreements;      ///< Number of samples of the move at which no single angle gives both the fine
                            ///< and the coarse count
};

inline constexpr int max_lane_filters = 4;

/// Controller blocks beyond the PID law: integral conditions, filters, cascade, observer and others. Lanes
/// without such blocks do not use it.
struct alignas(64) BlockLanes {
  loop::IntegralConstants<Lanes> integral;
  Lanes inside;      ///< 1 while the error is inside the integral's deadband (IntegralState::inside)
  Lanes pole;        ///< Pole a of the low-pass filter on the difference of counts
  Lanes difference;  ///< Filtered difference d of successive counts at the last sample, counts
  Lanes is_cascade;
  loop::CascadeConstants<Lanes> cascade;
  Lanes last_velocity_error;  ///< Velocity error of the cascade at the last sample, rad/s
  Lanes filter_count;
  loop::BiquadConstants<Lanes> filters[max_lane_filters];  ///< Coefficients of the torque filters; filters
                                                           ///< from index filter_count on pass the torque
                                                           ///< unchanged.
  loop::BiquadState<Lanes> filter_states[max_lane_filters];
  Lanes observes;
  loop::ObserverConstants<Lanes> observer;
  loop::BiquadState<Lanes> observer_state;
  Lanes first_count;
  Lanes remembers;  ///< 1 if the controller's torque may still change while the error stays 0
  loop::ErrorDeadbandConstants<Lanes> deadband;
  Lanes last_acting_error;  ///< Error e′ after the dead zone at the last sample, counts
  loop::StandstillConstants<Lanes> standstill;
  Lanes standstill_run;
  loop::HoldConstants<Lanes> hold;
  loop::HoldState<Lanes> hold_state;
  Lanes last_target;  ///< Target of the controller at the last sample, counts
  Lanes dither_amplitude, dither_frequency;
  Lanes sample;  ///< Number k of the next sample, counted from the start of the trial
  Lanes sigma_delta;
  Lanes remainder;  ///< Rounding error that the sigma-delta converter carries to the next sample, N m
};

inline constexpr int max_lane_ripples = 8;
/// Order of the Taylor series of a vibration over a sample. Up to half the sample rate, x = 2πf·T ≤ π, its
/// truncation error is x²⁵/25! = 2e-13 of the amplitude.
inline constexpr int vibration_order = 24;

inline constexpr int max_lane_lines = 8;

/// One sinusoidal line of a vibration torque: amplitude·sin(rate·t + phase).
struct LineLanes {
  Lanes amplitude;  ///< Amplitude, N m; 0 in lanes without this line
  Lanes rate;       ///< Angular frequency, rad/s
  Lanes phase;      ///< Phase at t = 0, rad
};

/// One torque ripple along the rotor: amplitude·sin(per_angle·θ + phase).
struct RippleLanes {
  Lanes amplitude;     ///< Amplitude, N m; 0 in lanes without this ripple
  Lanes per_angle;     ///< Phase of the ripple per angle of the rotor, rad/rad
  Lanes phase;         ///< Phase of the ripple at θ = 0, rad
  Lanes sine, cosine;  ///< Sine and cosine of the ripple's phase at the present θ
};

/// A torque on the rotor that varies between samples: settled + lag·exp(−decay·t) + vibration + ripples. A
/// piece is a time span in which the input of the motor's amplifier stays constant. Lanes with a constant
/// torque do not use it.
struct alignas(64) CourseLanes {
  Lanes settled;    ///< Final value of the motor's torque in this piece, plus the constant disturbance, N m
  Lanes lag;        ///< Difference of the motor's torque from its final value at the start of the piece, N m
  Lanes decay;      ///< Rate at which the lag decays, 1/s
  Lanes piece;      ///< Duration of the present piece, s
  Lanes piece_end;  ///< End of the present piece, measured from the nominal instant k·T of the last sample, s
  Lanes tolerance;  ///< Truncation error allowed per step (MotionTolerance::elongation), rad
  Lanes vibrates;   ///< Highest order with a non-zero coefficient in the vibration's series; 0 without a
                    ///< series
  /// Taylor series, about k·T, of a vibration with many lines: coefficients in powers of t/T, N m
  Lanes vibration[vibration_order + 1];
  Lanes move_start;  ///< Number of the move's first sample, counted from the start of the trial
  Lanes line_count;
  LineLanes lines[max_lane_lines];  ///< Lines of a vibration with few lines, used instead of the series
  Lanes left_out;  ///< Upper bound, until the lane's next stop, of the terms that the series of the lines
                   ///< omits (orders from batch_order on), N m
  Lanes ripple_count;
  RippleLanes ripples[max_lane_ripples];
  Lanes applied[batch_order];  ///< Taylor series of the torque without ripples about the present instant:
                               ///< coefficients from order 1 on, in powers of t/T, N m
};

inline constexpr int max_lane_delay = 4;  ///< Longest delay that the drive kernel handles, samples

/// Drive between converter and rotor: delay, amplifier and late samples. Only for lanes in which the
/// amplifier's input changes at most once per sample (needs_drive_kernel()). Lanes whose torque a LaneDrive
/// gives, and lanes without a drive, do not use it.
struct alignas(64) DriveLanes {
  Lanes delay;                    ///< Delay between deciding a torque and applying it, samples
  Lanes rate;                     ///< Rate 2πf at which the amplifier's torque approaches its input, f its
                                  ///< bandwidth, 1/s; 0 without an amplifier
  Lanes decay;                    ///< Factor by which the amplifier's lag decays within the last piece:
                                  ///< exp(−rate·duration)
  Lanes now;                      ///< Torque of the motor at the last sample, N m
  Lanes settled;                  ///< Final value that the motor's torque approaches, N m
  Lanes last;                     ///< Torque that the converter gave at the last sample, N m
  Lanes alike;                    ///< Number of successive samples at which the converter gave the torque
                                  ///< `last`
  Lanes waiting[max_lane_delay];  ///< Converter torques of the last samples, newest first, N m
  Lanes disturbed;                ///< 1 if a varying disturbance acts on the rotor
  Lanes stops;                    ///< 1 if the lane must stop at each sample although the motor's torque
                                  ///< stays
  Lanes jitter;                   ///< Largest lateness of a sample, s; 0 without late samples
  RandomLanes random;             ///< Random numbers for the lateness of samples
  Lanes sample;                   ///< Number k of the next sample, counted from the start of the trial
  Lanes late;                     ///< Time δ_k by which the next sample is late, s
};

/// The second mass behind an elastic coupling (motion::Load). Lanes without one do not use it.
struct alignas(64) LoadLanes {
  Lanes inertia;             ///< Inertia JL of the second mass, kg m²
  Lanes per_inertia;         ///< Reciprocal inertia 1/JL, 1/(kg m²)
  Lanes stiffness;           ///< Stiffness kL of the coupling, N m/rad
  Lanes damping;             ///< Damping dL of the coupling, N m s/rad
  Lanes torque_by_velocity;  ///< Largest coupling torque of an oscillation between the masses, per relative
                             ///< velocity, N m s/rad
  Lanes reads;               ///< 1 if the encoder that closes the loop reads the second mass
  Lanes twist;               ///< Twist δ of the coupling, rad
  Lanes omega;               ///< Velocity ωL of the second mass, rad/s
};

inline constexpr int max_lane_elements = 16;

/// The Maxwell-slip elements of friction::GmsFriction. Lanes with other friction laws do not use them. All
/// values of elements from index `count` on are 0.
struct alignas(64) ElementLanes {
  Lanes count;
  Lanes torque[max_lane_elements];     ///< Torque Fi of each element, N m
  Lanes slips[max_lane_elements];      ///< 1 if the element slips at this instant
  Lanes stiffness[max_lane_elements];  ///< Stiffness κi of each element, N m/rad
  Lanes weight[max_lane_elements];     ///< Proportion ηi of the friction level that each element carries
  Lanes attraction;                    ///< Attraction C, the rate at which a slipping element's torque goes
                                       ///< to its level, N m/s
  Lanes stiffest;                      ///< Largest stiffness κi of the lane's elements, N m/rad
  Lanes softest;                       ///< Smallest stiffness κi of the lane's elements, N m/rad
};

/// Measures of one error band |e| ≤ b, in every lane.
struct BandLanes : trial::BandMeasures<Lanes> {
  Lanes limit;  ///< Half width b of the error band, counts; infinite in lanes without this band
};

/// Measures of the present move up to the last sample, and other state of the move.
struct alignas(64) MeasureLanes : trial::RunningMeasures<Lanes> {
  trial::MeasureLimits<Lanes> limits;
  BandLanes bands[trial::max_error_bands];
  Lanes last_half;    ///< Number of the first sample in the last half of the move
  Lanes in_jerk;      ///< 1 while a jerk (an excursion of the error from zero after arrival) lasts
  Lanes change;       ///< Change of the count from the last but one sample to the last sample, counts
  Lanes first_error;  ///< |e_0|, the absolute error at the move's first sample, counts
  Lanes max_error;    ///< Limit of |e| − |e_0| beyond which the move has diverged and is ended, counts;
                      ///< infinite: never ended
  Lanes theta;        ///< Rotor angle θ at the last sample, rad
  Lanes extension;    ///< Plastic extension xp of the contact at the last sample, rad
  Lanes slid;         ///< 1 if a bristle slid at any sampling instant of the move
};

/// Events that a kernel reports for a lane; several events are combined as bits. friction::Sticking::Event
/// defines the events of the contact.
enum LaneEvent : int {
  no_event = 0,
  may_rest = 1 << 0,
  reversal = 1 << 1,  ///< A reversal at the end of a step is stored in MotionLanes::at_reversal instead.
  closure = 1 << 2,
  creep_on = 1 << 3,
  creep_off = 1 << 4,
  breakaway = 1 << 5,
  velocity_zero = 1 << 6,
  beyond_kernel = 1 << 7,  ///< The kernel cannot compute the step: the scalar plant must run the lane up to
                           ///< its next stop.
  jerk_changes = 1 << 8,
  diverges = 1 << 9,
  meets_event = 1 << 10,   ///< An event other than a reversal of the spring lies in the step; the step is not
                           ///< made.
  driven = 1 << 11,        ///< The lane has a LaneDrive, which must compute the torque on the rotor.
  count_changes = 1 << 12  ///< The encoder's count has changed at a sample in the last half of the move.
};

/// Sampling instants that one integration step of a lane passes over, because count and torque stay the same
/// there. Kept only for an observer of the samples.
struct PassedSamples {
  int lane;
  double samples;                      ///< Number of samples that the step passes over
  double time_to_stop;                 ///< Time from the start of the step to the lane's next stop, s
  double step;                         ///< Length of the full step, s
  double end;                          ///< Fraction of the full step that is used, 0 to 1
  double elongation[batch_order + 1];  ///< Coefficients of the spring's elongation xs, rad, as a power series
                                       ///< in the fraction of the step
  double creep[batch_order + 1];  ///< Coefficients of the creep xh·sgn(σ), rad, as a power series in the
                                  ///< fraction of the step
};

/// Code that decides the controller's torque at a sampling instant.
enum class Decider {
  pid,       ///< The vectorised sampling kernel, with the PID law alone.
  blocks,    ///< The vectorised sampling kernel, with controller blocks beyond the PID law.
  lane_loop  ///< The scalar LaneLoop of the lane, before the sampling kernel runs.
};

/// Kinds of torque that act on the rotors in one kernel call, besides a constant torque.
struct Forcing {
  static constexpr bool forced = true;
  bool varies;  ///< The torque on the rotor varies in time or along the angle, as course_kernel() computes
                ///< it.
  bool loaded;  ///< Whether a second mass is coupled to the rotor
  bool any() const { return varies || loaded; }
};
/// Compile-time counterpart of a Forcing without effects: the torque is constant and there is no second mass.
struct Unforced {
  static constexpr bool forced = false;
  static constexpr bool varies = false;
  static constexpr bool loaded = false;
  static constexpr bool any() { return false; }
};

/// The quantities that every lane uses. The struct consists of Lanes members only, so that it can be treated
/// as one array of Lanes.
struct LaneNumbers {
  MotionLanes motion;
  ContactLanes contact;
  FreeLanes free;
  TimeLanes time;
  LoopLanes loop;
  MeasureLanes measures;
};

struct BatchState : LaneNumbers {
  int events[lane_slots];

  int event_lanes[max_lanes];  ///< Indices of the lanes for which the last kernel call reported events.
  int event_count;

  PassedSamples* passed;  ///< Receives the samples passed over in a kernel call; null if no observer wants
                          ///< them.
  int passed_count;       ///< Number of entries in `passed`, at most one per lane and kernel call.

  // Last and apart, since fewer studies use them.
  CreepAheadLanes ahead;
  NoiseLanes noise;
  BlockLanes blocks;
  DriveLanes drive;
  CourseLanes course;
  LoadLanes load;
  ElementLanes elements;
};

}  // namespace zerocount::batch

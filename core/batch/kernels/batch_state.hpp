#pragma once

#include "core/batch/kernels/lane_set.hpp"
#include "core/friction/presliding/presliding_formulas.hpp"
#include "core/loop/controller/block_formulas.hpp"
#include "core/loop/formulas.hpp"
#include "core/trial/running_measures.hpp"

/// The trials that a batch engine has in work, one a lane: plain arrays, one quantity each, so that a kernel
/// takes the same quantity of many lanes at once. Flags are 0 or 1, whole numbers are exact doubles.
///
/// Included by the kernels: see simd.hpp for what must not be in here.
namespace zerocount::batch {

/// The spare lane fills up vectors; its contents affect no other lane. Rounded up to a cache line.
inline constexpr int lane_slots = max_lanes + 8;
inline constexpr int spare_lane = max_lanes;

inline constexpr int batch_order = 14;  ///< Order of the Taylor series of a step.
/// A lane with more steps since its last sample falls back to the reference.
inline constexpr double max_steps_to_stop = 500.0;

using Lanes = double[lane_slots];

/// The contact while the hook sticks, and the rotor.
struct alignas(64) MotionLanes {
  Lanes elongation;  ///< xs, or z of a bristle, rad
  Lanes omega;       ///< ω, rad/s
  Lanes extension;   ///< xp, rad
  Lanes hardening;   ///< xh, rad
  Lanes torque;      ///< Torque on the rotor without friction, N m
  Lanes hook;        ///< Position of the hook, rad
  Lanes theta;       ///< θ while the hook slides, and always for laws without a hook, rad

  Lanes branch_elongation;        ///< xr, rad
  Lanes branch_torque;            ///< σr, N m
  Lanes branch_sign;              ///< s
  Lanes branch_softening_torque;  ///< N m
  Lanes branch_softening_rate;    ///< 1/rad
  Lanes branch_softening_length;  ///< 1/branch_softening_rate, rad
  Lanes branch_end;  ///< Elongation at which the branch ends in the present direction, rad; ±infinity without
                     ///< an end
  Lanes direction;        ///< Direction of the elongation on the present branch: −1, 0, 1
  Lanes heading;          ///< Direction of the elongation from this instant on: −1, 0, 1
  Lanes at_reversal;      ///< dxs/dt is zero at this instant
  Lanes creeping;         ///< The creep law is on
  Lanes creep_onset;      ///< |σ| at which creep sets in, N m
  Lanes slide_direction;  ///< −1, 1; 0 while the hook sticks; 1 for laws without a hook, which move θ itself
  Lanes gradual_slide;    ///< The bristle, or all elements, slide at this instant
  Lanes rest_torque;      ///< Torque under which the plant is at rest, N m; NaN while it moves

  Lanes spring_torque;  ///< σ at the start of the step, N m
  Lanes torque_power;   ///< |σ|ⁿ at the start of the step
  Lanes softness;       ///< exp(−y) of the branch at the start of the step
};

/// Parameters of the motion, constant throughout a contact.
struct alignas(64) ContactLanes {
  Lanes inertia;          ///< J, kg m²
  Lanes per_inertia;      ///< 1/J
  Lanes damping;          ///< c
  Lanes sliding_damping;  ///< cs, or d of a bristle
  Lanes k1;               ///< N m/rad
  Lanes stiffest;         ///< k1 + k2, N m/rad
  Lanes alpha;            ///< 1/s
  Lanes per_lambda;       ///< 1/λ
  Lanes max_creep_ratio;  ///< 8αc/k1, which bounds the contribution of creep to dxs/dt, divided by dxp/dt
  Lanes creep_exponent;   ///< n
  Lanes breakaway;        ///< Fs, N m
  Lanes coulomb;          ///< Fc, N m
  Lanes per_velocity_squared;  ///< 1/ωs²
  Lanes fast_velocity;         ///< 8ωs, rad/s; the friction of a faster slide is Coulomb friction
  Lanes max_oscillation;       ///< Amplitude that may count as rest at a reversal, rad
  Lanes bristle_stiffness;     ///< σ0, N m/rad
  Lanes bristle_damping;       ///< σ1, N m s/rad
  Lanes spent;                 ///< StandingContact::spent
};

/// The motion without friction over one sample under the torque u + l·exp(−rt): θ ← θ + travel·ω + push·u +
/// lag_push·l, ω ← decay·ω + gain·u + lag_gain·l.
struct alignas(64) FreeLanes {
  Lanes travel;    ///< s
  Lanes push;      ///< rad/(N m)
  Lanes decay;     ///< dimensionless
  Lanes gain;      ///< rad/(N m s)
  Lanes lag_push;  ///< rad/(N m)
  Lanes lag_gain;  ///< rad/(N m s)
};

/// Description of the motion over some samples ahead, for a lane at rest that creeps and stops at every
/// sample. Only lanes in LaneStates::ahead use it; the plant of such a lane stays at the start of the
/// description.
struct alignas(64) CreepAheadLanes {
  Lanes elapsed;   ///< Time since the start of the description, by which the plant lags behind the lane, s
  Lanes duration;  ///< Duration that the description covers, s; 0 without a description
  // Without the oscillation, coefficients in elapsed/duration, rad.
  Lanes elongation[4];
  Lanes extension[4];
  Lanes hardening[4];
  friction::OscillationConstants<Lanes> oscillation;
  Lanes oscillation_end;  ///< ResidualOscillation::end, s
  Lanes start;            ///< Start of the description on the time axis of the oscillation, s
  Lanes creep_sign;       ///< sgn(σ)
};

/// Time and step control of a lane.
struct alignas(64) TimeLanes {
  Lanes time_to_stop;     ///< Time to the next stop, s
  Lanes samples_to_stop;  ///< Samples to the next stop, including the one at the stop
  Lanes time_scale;       ///< 1/ωn with ωn² = (k1 + k2)/J, s
  Lanes next_step;        ///< Step that is expected to be accurate enough, s
  Lanes steps;            ///< Steps tried since the last sample
  Lanes sample_time;      ///< T, s
  Lanes sample_rate;      ///< 1/T, Hz
  Lanes tolerance;        ///< Truncation error allowed per sample time, rad
  Lanes per_count;        ///< 1/Δx, 1/rad
  Lanes rest;             ///< Amplitude that counts as rest, rad
};

/// Encoder, control and converter.
struct alignas(64) LoopLanes {
  Lanes resolution;  ///< Δx of the fine encoder, rad
  Lanes phase;
  Lanes kp, ki, kd;                         ///< N m/count
  Lanes lowest_integral, highest_integral;  ///< N m
  Lanes dac_resolution;                     ///< Δu, N m
  Lanes lowest_code, highest_code;
  Lanes target;      ///< Target, counts
  Lanes integral;    ///< I, N m
  Lanes error;       ///< Error at the last sample, counts
  Lanes count;       ///< Count of the last sample. Before the first sample: n_{−1} − n_0.
  Lanes quiet_from;  ///< Lower bound of θ/Δx + phase − count within which samples may be passed, counts
  Lanes quiet_to;  ///< Upper bound of θ/Δx + phase − count within which samples may be passed, counts. The
                   ///< bounds are 0 and 1 if only the encoder's reading is measured, and infinite if not even
                   ///< that is.
  Lanes counted;      ///< 1 once there has been a sample
  Lanes decided;      ///< Torque decided at the last sample, N m
  Lanes converted;    ///< Output of the converter for the decided torque, N m; given by the LaneLoop if the
                      ///< lane has one
  Lanes code;         ///< Converter code of the last sample
  Lanes steady;       ///< 1 if the torque will stay as long as the count does
  Lanes driven;       ///< 1 if a LaneDrive lies between the decided torque and the rotor
  Lanes disturbance;  ///< Constant torque on the rotor besides the motor's, N m
  Lanes read_twist;   ///< θ minus the angle that the encoder reads, if that is the load's, rad; otherwise 0
  // Results of the LaneLoop at this sample. Lanes without a LaneLoop do not use them.
  Lanes given_count;
  Lanes given_code;
  Lanes given_decided;  ///< Decided torque, N m
  Lanes given_clipped;  ///< 1 if the converter was out of range
  Lanes given_may_stay;
  Lanes given_stays;  ///< 1 if the torque stays whatever the count is
};

/// One of the streams of random numbers (random::random_bits_at), as whole numbers below 2³².
struct RandomLanes {
  Lanes trial_low, trial_high;
  Lanes stream;
  Lanes key[2];
};

/// The noise of the fine encoder, and the coarse encoder beside it. Lanes without noise do not use it.
struct alignas(64) NoiseLanes {
  RandomLanes random;
  loop::NoiseConstants<Lanes> constants;
  Lanes sample;             ///< Number k of the next sample from the start of the trial
  Lanes state;              ///< Noise state w of the last sample
  Lanes coarse_resolution;  ///< rad
  Lanes disagreements;      ///< Samples of the move at which no single angle gives both counts
};

inline constexpr int max_lane_filters = 4;

/// The controller's blocks. Lanes without blocks do not use it.
struct alignas(64) BlockLanes {
  loop::IntegralConstants<Lanes> integral;
  Lanes inside;      ///< IntegralState::inside
  Lanes pole;        ///< Pole of the derivative filter
  Lanes difference;  ///< Filtered difference d of the last sample, counts
  Lanes is_cascade;
  loop::CascadeConstants<Lanes> cascade;
  Lanes last_velocity_error;  ///< rad/s
  Lanes filter_count;
  loop::BiquadConstants<Lanes> filters[max_lane_filters];  ///< Filters beyond filter_count have the gain 1.
  loop::BiquadState<Lanes> filter_states[max_lane_filters];
  Lanes observes;
  loop::ObserverConstants<Lanes> observer;
  loop::BiquadState<Lanes> observer_state;
  Lanes first_count;
  Lanes remembers;  ///< 1 if the torque may change while the error stays 0
  loop::ErrorDeadbandConstants<Lanes> deadband;
  Lanes last_acting_error;  ///< Error e′ after the dead zone at the last sample, counts
  loop::StandstillConstants<Lanes> standstill;
  Lanes standstill_run;
  loop::HoldConstants<Lanes> hold;
  loop::HoldState<Lanes> hold_state;
  Lanes last_target;  ///< Target at the last sample, counts
  Lanes dither_amplitude, dither_frequency;
  Lanes sample;  ///< Number k of the next sample from the start of the trial
  Lanes sigma_delta;
  Lanes remainder;  ///< Rounding remainder of the sigma-delta converter, N m
};

inline constexpr int max_lane_ripples = 8;
/// Order of the Taylor series of a vibration over a sample. Up to half the sample rate, x = 2πf·T ≤ π, its
/// truncation error is x²⁵/25! = 2e-13 of the amplitude.
inline constexpr int vibration_order = 24;

inline constexpr int max_lane_lines = 8;

/// One line of a vibration: amplitude·sin(rate·t + phase).
struct LineLanes {
  Lanes amplitude;  ///< N m; 0 in lanes without this line
  Lanes rate;       ///< rad/s
  Lanes phase;      ///< rad
};

/// One ripple: amplitude·sin(per_angle·θ + phase).
struct RippleLanes {
  Lanes amplitude;     ///< N m; 0 in lanes without this ripple
  Lanes per_angle;     ///< rad/rad
  Lanes phase;         ///< rad
  Lanes sine, cosine;  ///< Sine and cosine of the ripple's phase at the present θ
};

/// A varying torque on the rotor: settled + lag·exp(−decay·t) + vibration + ripples. Lanes with a constant
/// torque do not use it.
struct alignas(64) CourseLanes {
  Lanes settled;    ///< Final value of the motor's torque in this piece, plus the constant disturbance, N m
  Lanes lag;        ///< Difference of the motor's torque from its final value at the start of the piece, N m
  Lanes decay;      ///< Rate at which the lag decays, 1/s
  Lanes piece;      ///< Duration of the piece, s
  Lanes piece_end;  ///< End of the piece after the nominal instant k·T of the last sample, s
  Lanes tolerance;  ///< MotionTolerance::elongation, rad
  Lanes vibrates;   ///< Highest non-zero order of the vibration's series; 0 without a series
  /// Series of a vibration with many lines about k·T, coefficients in t/T, N m
  Lanes vibration[vibration_order + 1];
  Lanes move_start;  ///< Number of the move's first sample from the start of the trial
  Lanes line_count;
  LineLanes lines[max_lane_lines];  ///< Lines of a vibration with few lines, used instead of the series
  Lanes left_out;  ///< Bound of the contribution of the orders from batch_order on to the lines up to a stop,
                   ///< N m
  Lanes ripple_count;
  RippleLanes ripples[max_lane_ripples];
  Lanes applied[batch_order];  ///< Series of the torque without ripples about the present instant, orders ≥
                               ///< 1, coefficients in t/T, N m
};

inline constexpr int max_lane_delay = 4;  ///< Longest delay that the drive kernel handles, samples

/// Delay, amplifier and late samples between the converter and the rotor, for lanes in which the torque of a
/// sample is one piece (needs_drive_kernel). Lanes whose torque a LaneDrive gives, and lanes without a drive,
/// do not use it.
struct alignas(64) DriveLanes {
  Lanes delay;                    ///< Delay, samples
  Lanes rate;                     ///< Rate 2πf of the amplifier, 1/s; 0 without an amplifier
  Lanes decay;                    ///< exp(−rate·duration) of the last piece
  Lanes now;                      ///< Torque of the motor at the last sample, N m
  Lanes settled;                  ///< Final value that the motor's torque approaches, N m
  Lanes last;                     ///< Torque of the converter at the last sample, N m
  Lanes alike;                    ///< Number of successive samples with the torque `last`
  Lanes waiting[max_lane_delay];  ///< Converter torques of the last samples, newest first, N m
  Lanes disturbed;                ///< 1 if a varying disturbance acts on the rotor
  Lanes stops;                    ///< 1 if the lane stops at each sample although the motor's torque stays
  Lanes jitter;                   ///< Largest lateness of a sample, s; 0 without late samples
  RandomLanes random;             ///< Random numbers for the lateness of samples
  Lanes sample;                   ///< Number k of the next sample
  Lanes late;                     ///< Lateness δ_k of the next sample, s
};

/// The second mass (motion::Load). Lanes without one do not use it.
struct alignas(64) LoadLanes {
  Lanes inertia;             ///< JL, kg m²
  Lanes per_inertia;         ///< 1/JL
  Lanes stiffness;           ///< kL, N m/rad
  Lanes damping;             ///< dL, N m s/rad
  Lanes torque_by_velocity;  ///< Bound of the torque of an oscillation, per relative velocity, N m s/rad
  Lanes reads;               ///< 1 if the encoder reads the load
  Lanes twist;               ///< δ, rad
  Lanes omega;               ///< ωL, rad/s
};

inline constexpr int max_lane_elements = 16;

/// The elements of friction::GmsFriction. Lanes with other laws do not use them. Elements from index `count`
/// on are 0.
struct alignas(64) ElementLanes {
  Lanes count;
  Lanes torque[max_lane_elements];     ///< Fi, N m
  Lanes slips[max_lane_elements];      ///< 1 if the element slips at this instant
  Lanes stiffness[max_lane_elements];  ///< κi, N m/rad
  Lanes weight[max_lane_elements];     ///< ηi
  Lanes attraction;                    ///< C, N m/s
  Lanes stiffest;                      ///< Largest κi, N m/rad
  Lanes softest;                       ///< Least κi, N m/rad
};

/// One error band of the lanes.
struct BandLanes : trial::BandMeasures<Lanes> {
  Lanes limit;  ///< b, counts; infinite in lanes without this band
};

/// The measures of the move so far, and other state of it.
struct alignas(64) MeasureLanes : trial::RunningMeasures<Lanes> {
  trial::MeasureLimits<Lanes> limits;
  BandLanes bands[trial::max_error_bands];
  Lanes last_half;    ///< Number of the first sample in the last half of the move
  Lanes in_jerk;      ///< 1 while a jerk lasts
  Lanes change;       ///< Change of the count from the sample before to the last one
  Lanes first_error;  ///< |e_0|, counts
  Lanes max_error;    ///< Excess of |e| over |e_0| beyond which the move is ended, counts; infinite: never
  Lanes theta;        ///< θ at the last sample, rad
  Lanes extension;    ///< Extension xp at the last sample, rad
  Lanes slid;         ///< 1 if a bristle slid at a sampling instant of the move
};

/// Events that a kernel reports for a lane, as a sum of flags. friction::Sticking::Event defines the events
/// of the contact.
enum LaneEvent : int {
  no_event = 0,
  may_rest = 1 << 0,
  reversal = 1 << 1,  ///< A reversal at the end of a step is stored in MotionLanes::at_reversal instead.
  closure = 1 << 2,
  creep_on = 1 << 3,
  creep_off = 1 << 4,
  breakaway = 1 << 5,
  velocity_zero = 1 << 6,
  beyond_kernel = 1 << 7,  ///< The scalar plant must run the lane up to the next stop.
  jerk_changes = 1 << 8,
  diverges = 1 << 9,
  meets_event = 1 << 10,   ///< An event other than a reversal lies in the step.
  driven = 1 << 11,        ///< The lane has a LaneDrive.
  count_changes = 1 << 12  ///< The count has changed in the last half of the move.
};

/// Sampling instants that a step passes over, because count and torque stay the same there. Kept only for an
/// observer.
struct PassedSamples {
  int lane;
  double samples;                      ///< Number of samples passed
  double time_to_stop;                 ///< TimeLanes::time_to_stop at the start of the step, s
  double step;                         ///< Length of the step, s
  double end;                          ///< Fraction of the step that is used
  double elongation[batch_order + 1];  ///< xs, rad, as a series in the fraction of the step
  double creep[batch_order + 1];       ///< xh·sgn(σ), rad, as a series in the fraction of the step
};

/// The part of the program that decides the torque at a sample.
enum class Decider {
  pid,       ///< The sampling kernel, by the PID law alone.
  blocks,    ///< The sampling kernel, by the controller's blocks.
  lane_loop  ///< LaneLoop, before the sampling kernel runs.
};

/// What acts on the rotors in one call of a kernel, besides a constant torque.
struct Forcing {
  static constexpr bool forced = true;
  bool varies;  ///< The torque varies, as course_kernel computes it.
  bool loaded;  ///< A second mass is coupled to the rotor.
  bool any() const { return varies || loaded; }
};
/// No forcing: the torque stays and there is no second mass. This is known when a kernel is compiled.
struct Unforced {
  static constexpr bool forced = false;
  static constexpr bool varies = false;
  static constexpr bool loaded = false;
  static constexpr bool any() { return false; }
};

/// Quantities that every lane uses, laid out as one array of Lanes.
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

  int event_lanes[max_lanes];  ///< Lanes with events of the last kernel call.
  int event_count;

  PassedSamples* passed;  ///< Samples passed in a kernel call; null without an observer.
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

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

inline constexpr int batch_order = 14;  ///< of the Taylor series
/// A lane with more steps since its last sample falls back to the reference.
inline constexpr double max_steps_to_stop = 500.0;

using Lanes = double[lane_slots];

/// The contact while the hook sticks, and the rotor.
struct alignas(64) MotionLanes {
  Lanes elongation;  ///< xs, or z of a bristle, rad
  Lanes omega;       ///< ω, rad/s
  Lanes extension;   ///< xp, rad
  Lanes hardening;   ///< xh, rad
  Lanes torque;      ///< on the rotor, without friction, N m
  Lanes hook;        ///< rad
  Lanes theta;       ///< θ while the hook slides, and of laws without a hook, rad

  Lanes branch_elongation;        ///< xr, rad
  Lanes branch_torque;            ///< σr, N m
  Lanes branch_sign;              ///< s
  Lanes branch_softening_torque;  ///< N m
  Lanes branch_softening_rate;    ///< 1/rad
  Lanes branch_softening_length;  ///< its reciprocal, rad
  Lanes branch_end;               ///< where the branch ends ahead, rad; ±infinity where it does not
  Lanes direction;                ///< of the elongation: −1, 0, 1
  Lanes heading;                  ///< the direction from now on: −1, 0, 1
  Lanes at_reversal;              ///< dxs/dt is zero at this instant
  Lanes creeping;                 ///< the creep law is on
  Lanes creep_onset;              ///< |σ| at which it sets in, N m
  Lanes slide_direction;  ///< −1, 1; 0 while the hook sticks; 1 for laws without a hook, which move θ itself
  Lanes gradual_slide;    ///< the bristle, or all elements, slide at this instant
  Lanes rest_torque;      ///< torque under which the plant is at rest, N m; NaN: it moves

  Lanes spring_torque;  ///< σ at the start of the step, N m
  Lanes torque_power;   ///< |σ|ⁿ at the start of the step
  Lanes softness;       ///< exp(−y) of the branch at the start of the step
};

/// Parameters of the motion, constant throughout a contact.
struct alignas(64) ContactLanes {
  Lanes inertia;               ///< J, kg m²
  Lanes per_inertia;           ///< 1/J
  Lanes damping;               ///< c
  Lanes sliding_damping;       ///< cs, or d of a bristle
  Lanes k1;                    ///< N m/rad
  Lanes stiffest;              ///< k1 + k2, N m/rad
  Lanes alpha;                 ///< 1/s
  Lanes per_lambda;            ///< 1/λ
  Lanes max_creep_ratio;       ///< 8αc/k1: bound of the part of dxs/dt that creep causes, by dxp/dt
  Lanes creep_exponent;        ///< n
  Lanes breakaway;             ///< Fs, N m
  Lanes coulomb;               ///< Fc, N m
  Lanes per_velocity_squared;  ///< 1/ωs²
  Lanes fast_velocity;         ///< 8ωs, rad/s: faster slides have Coulomb friction
  Lanes max_oscillation;       ///< amplitude that may count as rest at a reversal, rad
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

/// The motion of a lane that creeps at rest and is sampled all the time, over some samples ahead. Only lanes
/// in LaneStates::ahead use it; their plant stands where the description begins.
struct alignas(64) CreepAheadLanes {
  Lanes elapsed;   ///< time since its start, by which the plant lags behind the lane, s
  Lanes duration;  ///< s; 0 if there is no description
  // Without the oscillation, coefficients in elapsed/duration, rad.
  Lanes elongation[4];
  Lanes extension[4];
  Lanes hardening[4];
  friction::OscillationConstants<Lanes> oscillation;
  Lanes oscillation_end;  ///< ResidualOscillation::end, s
  Lanes start;            ///< of the description, in the time of the oscillation, s
  Lanes creep_sign;       ///< sgn(σ)
};

/// Time and step control of a lane.
struct alignas(64) TimeLanes {
  Lanes time_to_stop;     ///< to the next stop, s
  Lanes samples_to_stop;  ///< including the one at the stop
  Lanes time_scale;       ///< 1/ωn with ωn² = (k1 + k2)/J, s
  Lanes next_step;        ///< step that is expected to be accurate, s
  Lanes steps;            ///< tried since the last sample
  Lanes sample_time;      ///< T, s
  Lanes sample_rate;      ///< 1/T, Hz
  Lanes tolerance;        ///< of a torque step, rad
  Lanes per_count;        ///< 1/Δx, 1/rad
  Lanes rest;             ///< amplitude that counts as rest, rad
};

/// Encoder, control and converter.
struct alignas(64) LoopLanes {
  Lanes resolution;  ///< Δx of the fine encoder, rad
  Lanes phase;
  Lanes kp, ki, kd;                         ///< N m/count
  Lanes lowest_integral, highest_integral;  ///< N m
  Lanes dac_resolution;                     ///< Δu, N m
  Lanes lowest_code, highest_code;
  Lanes target;       ///< counts
  Lanes integral;     ///< I, N m
  Lanes error;        ///< of the last sample, counts
  Lanes count;        ///< count of the last sample; before the first sample n_{−1} − n_0
  Lanes quiet_from;   ///< samples may be passed while θ/Δx + phase − count lies from here, counts;
  Lanes quiet_to;     ///< to here. 0 and 1 where nothing is measured but what the encoder reads; infinite
                      ///< where that is not measured either
  Lanes counted;      ///< there has been a sample
  Lanes decided;      ///< torque of the last sample, N m
  Lanes converted;    ///< that the converter made of it, N m; decided by the LaneLoop where there is one
  Lanes code;         ///< of the last sample
  Lanes steady;       ///< the torque will stay as long as the count does
  Lanes driven;       ///< a LaneDrive lies between the decided torque and the rotor
  Lanes disturbance;  ///< constant torque on the rotor beside the motor's, N m
  Lanes read_twist;   ///< θ less the angle that the encoder reads, of a load; else 0, rad
  // Decided by the LaneLoop at this sample; other lanes do not use it:
  Lanes given_count;
  Lanes given_code;
  Lanes given_decided;  ///< torque, N m
  Lanes given_clipped;  ///< the converter was out of range
  Lanes given_may_stay;
  Lanes given_stays;  ///< whatever the count
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
  Lanes sample;             ///< k, from the start of the trial
  Lanes state;              ///< w of the last sample
  Lanes coarse_resolution;  ///< rad
  Lanes disagreements;      ///< samples of the move with readings of no single angle
};

inline constexpr int max_lane_filters = 4;

/// The controller's blocks. Lanes without blocks do not use it.
struct alignas(64) BlockLanes {
  loop::IntegralConstants<Lanes> integral;
  Lanes inside;      ///< IntegralState::inside
  Lanes pole;        ///< of the derivative filter
  Lanes difference;  ///< d of the last sample, counts
  Lanes is_cascade;
  loop::CascadeConstants<Lanes> cascade;
  Lanes last_velocity_error;  ///< rad/s
  Lanes filter_count;
  loop::BiquadConstants<Lanes> filters[max_lane_filters];  ///< beyond filter_count those of the gain 1
  loop::BiquadState<Lanes> filter_states[max_lane_filters];
  Lanes observes;
  loop::ObserverConstants<Lanes> observer;
  loop::BiquadState<Lanes> observer_state;
  Lanes first_count;
  Lanes remembers;  ///< the torque may change while the error stays 0
  loop::ErrorDeadbandConstants<Lanes> deadband;
  Lanes last_acting_error;  ///< e′ of the last sample, counts
  loop::StandstillConstants<Lanes> standstill;
  Lanes standstill_run;
  loop::HoldConstants<Lanes> hold;
  loop::HoldState<Lanes> hold_state;
  Lanes last_target;  ///< of the last sample, counts
  Lanes dither_amplitude, dither_frequency;
  Lanes sample;  ///< k, from the start of the trial
  Lanes sigma_delta;
  Lanes remainder;  ///< of the sigma-delta converter, N m
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
  Lanes sine, cosine;  ///< at the present θ
};

/// The torque on the rotor where it varies: settled + lag·exp(−decay·t) + vibration + ripples. Lanes
/// whose torque is constant do not use it.
struct alignas(64) CourseLanes {
  Lanes settled;    ///< what the motor's torque approaches, and the constant disturbance, N m
  Lanes lag;        ///< of the motor's torque at the start of the piece, N m
  Lanes decay;      ///< 1/s
  Lanes piece;      ///< duration of the piece, s
  Lanes piece_end;  ///< from the nominal instant k·T of the last sample, s
  Lanes tolerance;  ///< MotionTolerance::elongation, rad
  Lanes vibrates;   ///< highest order of the vibration's series that is not 0; 0 without a series
  Lanes vibration[vibration_order + 1];  ///< of many lines, about k·T, coefficients in t/T, N m
  Lanes move_start;                      ///< number of the move's first sample from the start of the trial
  Lanes line_count;
  LineLanes lines[max_lane_lines];  ///< few of them, in place of a series
  Lanes left_out;  ///< bound of what order batch_order on adds to the lines up to a stop, N m
  Lanes ripple_count;
  RippleLanes ripples[max_lane_ripples];
  Lanes applied[batch_order];  ///< without ripples, about the present instant, coefficients ≥ 1 in t/T, N m
};

inline constexpr int max_lane_delay = 4;  ///< samples

/// Delay and amplifier between the converter and the rotor, and late samples, where the torque of a sample is
/// one piece (needs_drive_kernel). Lanes with a LaneDrive, or without any, do not use it.
struct alignas(64) DriveLanes {
  Lanes delay;                    ///< samples
  Lanes rate;                     ///< of the amplifier, 1/s; 0 without one
  Lanes decay;                    ///< exp(−rate·duration) of the last piece
  Lanes now;                      ///< torque of the motor at the last sample, N m
  Lanes settled;                  ///< that it approaches, N m
  Lanes last;                     ///< torque of the converter at the last sample, N m
  Lanes alike;                    ///< samples in a row with this torque
  Lanes waiting[max_lane_delay];  ///< of the samples before, N m
  Lanes disturbed;                ///< by a disturbance that varies
  Lanes stops;                    ///< at each sample, although the motor's torque stays
  Lanes jitter;                   ///< s; 0 without late samples
  RandomLanes random;             ///< of the jitter
  Lanes sample;                   ///< k of the next sample
  Lanes late;                     ///< δ_k of the next sample, s
};

/// The second mass (motion::Load). Lanes without one do not use it.
struct alignas(64) LoadLanes {
  Lanes inertia;             ///< JL, kg m²
  Lanes per_inertia;         ///< 1/JL
  Lanes stiffness;           ///< kL, N m/rad
  Lanes damping;             ///< dL, N m s/rad
  Lanes torque_by_velocity;  ///< largest torque of an oscillation by its relative velocity, N m s/rad
  Lanes reads;               ///< the encoder reads the load
  Lanes twist;               ///< δ, rad
  Lanes omega;               ///< ωL, rad/s
};

inline constexpr int max_lane_elements = 16;

/// The elements of friction::GmsFriction. Lanes of other laws do not use them. Beyond `count` all is 0.
struct alignas(64) ElementLanes {
  Lanes count;
  Lanes torque[max_lane_elements];     ///< Fi, N m
  Lanes slips[max_lane_elements];      ///< at this instant
  Lanes stiffness[max_lane_elements];  ///< κi, N m/rad
  Lanes weight[max_lane_elements];     ///< ηi
  Lanes attraction;                    ///< C, N m/s
  Lanes stiffest;                      ///< largest κi, N m/rad
  Lanes softest;                       ///< least κi, N m/rad
};

/// One error band of the lanes.
struct BandLanes : trial::BandMeasures<Lanes> {
  Lanes limit;  ///< b, counts; infinite in lanes without this band
};

/// The measures of the move so far, and other state of it.
struct alignas(64) MeasureLanes : trial::RunningMeasures<Lanes> {
  trial::MeasureLimits<Lanes> limits;
  BandLanes bands[trial::max_error_bands];
  Lanes last_half;    ///< first sample of the last half
  Lanes in_jerk;      ///< a jerk lasts
  Lanes change;       ///< of the count with the last sample
  Lanes first_error;  ///< |e_0|, counts
  Lanes max_error;    ///< beyond |e_0|, with which the move is ended, counts; infinite: never
  Lanes theta;        ///< at the last sample, rad
  Lanes extension;    ///< at the last sample, rad
  Lanes slid;         ///< a bristle slid at a sampling instant of the move
};

/// Events of a lane that a kernel reports: a sum of these. Those of the contact: friction::Sticking::Event.
enum LaneEvent : int {
  no_event = 0,
  may_rest = 1 << 0,
  reversal = 1 << 1,  ///< at the end of a step it is stored in MotionLanes::at_reversal instead
  closure = 1 << 2,
  creep_on = 1 << 3,
  creep_off = 1 << 4,
  breakaway = 1 << 5,
  velocity_zero = 1 << 6,
  beyond_kernel = 1 << 7,  ///< the scalar plant runs the lane up to the next stop
  jerk_changes = 1 << 8,
  diverges = 1 << 9,
  meets_event = 1 << 10,   ///< an event other than a reversal lies in the step
  driven = 1 << 11,        ///< the lane has a LaneDrive
  count_changes = 1 << 12  ///< in the last half of the move
};

/// The sampling instants within a step, at which count and torque stay the same. Kept only for an observer.
struct PassedSamples {
  int lane;
  double samples;                      ///< how many
  double time_to_stop;                 ///< TimeLanes::time_to_stop at the start of the step, s
  double step;                         ///< s
  double end;                          ///< fraction of the step that was taken
  double elongation[batch_order + 1];  ///< xs, rad, as a series in the fraction of the step
  double creep[batch_order + 1];       ///< xh·sgn(σ), rad, as a series in the fraction of the step
};

/// Which part of the program decides at a sample.
enum class Decider {
  pid,       ///< the sampling kernel, with the PID law alone
  blocks,    ///< the sampling kernel, with the blocks of the controller
  lane_loop  ///< LaneLoop, before the sampling kernel
};

/// What acts on the rotors of the lanes of a kernel's call, beside a torque that stays.
struct Forcing {
  static constexpr bool forced = true;
  bool varies;  ///< the torque is that of course_kernel
  bool loaded;  ///< a second mass is coupled to the rotor
  bool any() const { return varies || loaded; }
};
/// Neither, which is known when a kernel is compiled.
struct Unforced {
  static constexpr bool forced = false;
  static constexpr bool varies = false;
  static constexpr bool loaded = false;
  static constexpr bool any() { return false; }
};

/// All numbers of the lanes except those of blocks, as one array of Lanes.
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

  int event_lanes[max_lanes];  ///< lanes with events of the last kernel
  int event_count;

  PassedSamples* passed;  ///< null without an observer
  int passed_count;       ///< at most one a lane and kernel call

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

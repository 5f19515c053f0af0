#pragma once

#include <random>
#include <vector>

#include "analysis/record/records/raw_series.hpp"
#include "core/motion/disturbance.hpp"

namespace zerocount::testing {

/// A linear axis with bristle friction, which yields before it slides (Dahl's law with a viscous damper);
/// units m, N, kg.
struct BristleAxis {
  double mass{95.0};
  double damping{200.0};        ///< viscous damping, N s/m
  double coulomb{20.0};         ///< Coulomb level, N
  double offset{3.0};           ///< constant force against the drive, N
  double bristle_travel{5e-6};  ///< travel over which the friction approaches its level, m
};

/// A positioning loop, its encoder and its moves.
struct DwellLoop {
  double sample_time{1e-3};  ///< sample time, s
  double resolution{5e-8};   ///< encoder resolution, m
  double noise{0.0};         ///< standard deviation of the readings, m
  double bandwidth{12.0};    ///< bandwidth of the loop, Hz
  double amplitude{0.05};    ///< largest distance of a target from the origin, m
  double move{0.5};          ///< duration of a move, s
  double dwell{1.0};         ///< duration of a dwell, s
  int moves{6};              ///< number of moves, to and fro, with different lengths
};

/// The record of moves with dwells under a PID loop. The simulation is independent of the program: it uses
/// nothing of core.
records::RawSeries dwell_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random);

/// The record of a force given in advance, without a loop: pulses that move the axis, with rests and slow
/// ramps below the Coulomb level between them.
records::RawSeries pulsed_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random);

/// A sliding axis, in the units of a linear axis: m, N, kg.
struct SlidingAxis {
  double mass{95.1089};
  double damping{203.5034};              ///< viscous damping, N s/m
  double coulomb{20.3935};               ///< Coulomb level, N
  double offset{-3.1648};                ///< constant force against the drive, N
  double breakaway{20.3935};             ///< breakaway force, N
  double stribeck_velocity{0.01};        ///< Stribeck velocity, m/s
  double bristle_stiffness{0.0};         ///< σ0 of Dahl's law, N/m; 0: Coulomb's law
  double friction_noise{0.0};            ///< standard deviation of a force that the record does not show, N
  bool rotary{false};                    ///< a rotary axis: N m for N and rad for m
  std::vector<motion::Ripple> ripple{};  ///< torques that depend on the position and act on the axis
};

/// Drive, position sensor and control loop of a simulated axis.
struct AxisLoop {
  double gain{35.15065};         ///< drive gain, N/V
  double position_gain{160.18};  ///< gain of the position loop, 1/s
  double velocity_gain{243.45};  ///< gain of the velocity loop, V s/m
  double voltage_limit{10.0};    ///< largest voltage magnitude of the drive, V
  double resolution{5e-8};       ///< encoder resolution, m
  double sample_time{1e-3};      ///< sample time, s
  double noise{0.0};             ///< standard deviation of the readings, m
};

/// A move with constant velocity: signed velocity, m/s, and duration, s.
struct Cruise {
  double velocity;
  double duration;
};

/// The velocities of one lap of the electro-mechanical positioning system (EMPS) of A. Janot, M. Gautier and
/// M. Brunot, Data Set and Reference Models of EMPS, 2019 Workshop on Nonlinear System Identification
/// Benchmarks, Eindhoven: 1 kHz, trapezoidal velocities up to 0.123 m/s with 0.83 m/s², four equal laps of
/// 6.24 s, a cascade of P position and velocity control, ±10 V, steps of 0.05 µm. The defaults of SlidingAxis
/// and AxisLoop are its published parameters and gains.
std::vector<Cruise> emps_lap();

/// The record of `laps` laps under closed loop, with force and position at each sample; the force is held to
/// the next sample. The motion is that of core's Plant with the law `coulomb`.
records::RawSeries closed_loop_record(const SlidingAxis& axis, const AxisLoop& loop,
                                      const std::vector<Cruise>& lap, int laps, std::mt19937_64& random);

/// The record of a force given in advance, the sum of two sines, without a loop.
records::RawSeries open_loop_record(const SlidingAxis& axis, const AxisLoop& loop, double duration,
                                    std::mt19937_64& random);

}  // namespace zerocount::testing

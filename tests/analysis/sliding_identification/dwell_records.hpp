#pragma once

#include <random>

#include "analysis/records/raw_series.hpp"

namespace zerocount::testing {

/// A linear axis whose friction is that of bristles, which yield before they slide (Dahl's law with a viscous
/// damper); m, N, kg.
struct BristleAxis {
  double mass{95.0};
  double damping{200.0};        ///< N s/m
  double coulomb{20.0};         ///< N
  double offset{3.0};           ///< N, against the drive
  double bristle_travel{5e-6};  ///< over which the friction approaches its level, m
};

/// A positioning loop, its encoder and its moves.
struct DwellLoop {
  double sample_time{1e-3};  ///< s
  double resolution{5e-8};   ///< m
  double noise{0.0};         ///< of the readings, standard deviation, m
  double bandwidth{12.0};    ///< Hz
  double amplitude{0.05};    ///< of the moves, m
  double move{0.5};          ///< s
  double dwell{1.0};         ///< s
  int moves{6};              ///< to and fro, of different lengths
};

/// Moves with dwells under a PID loop. The simulation is its own: nothing of core is in it.
records::RawSeries dwell_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random);

/// The force given beforehand, without a loop: pulses that move the axis, with rests and slow ramps below the
/// Coulomb level between them.
records::RawSeries pulsed_record(const BristleAxis& axis, const DwellLoop& loop, std::mt19937_64& random);

}  // namespace zerocount::testing

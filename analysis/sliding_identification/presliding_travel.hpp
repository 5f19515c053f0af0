#pragma once

#include <span>

#include "analysis/sliding_identification/sliding_record.hpp"

namespace zerocount::sliding_identification {

/// Travel from the start of a run, rad or m, beyond which the axis slides; 0 where the readings show no
/// pre-sliding motion.
///
/// A run is a motion in one direction, from a standstill or a reversal. Before it slides, the friction rises
/// with the travel s since its start, whatever the law; while it slides, it does not depend on s. A dwell
/// that ends where it began, in which the rotor creeps under the loop's integral, is short runs with little
/// friction. Fitted by least squares is
///
///   u = J·a + cs·v + u0 + d·(Fc + D_i),   d = ±1 the direction,
///
/// with a level Fc + D_i for each band of s (ratio √2), and Fc above the band in question. Bands are taken
/// from the longest travels down. The axis does not slide in the first band with D_i < −Fc/20, by 3 standard
/// errors, below which the deficit is on average as large at least (friction that varies along the axis makes
/// other patterns). Laws approach their level exponentially, so four times the upper end of that band is
/// returned, unless more than a quarter of the longest run would be lost.
/// @param record with its velocities
double presliding_travel(const SlidingRecord& record, std::span<const Window> runs);

}  // namespace zerocount::sliding_identification

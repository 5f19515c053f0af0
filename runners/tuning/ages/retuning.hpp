#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runners/tuning/ages/age_runs.hpp"

/// Gains that are tuned again at intervals of a life, and what they buy over one set of gains.
namespace zerocount::tuning {

/// The life of a machine between two tunings. Gains that are tuned at its beginning act up to its end, so
/// they have to hold at both.
struct LifeInterval {
  std::vector<double> ages;  ///< rising: its ends, and the ages of the study between them
  double from() const { return ages.front(); }
  double to() const { return ages.back(); }
};

inline constexpr std::size_t max_life_intervals = 50;

/// The life from the first to the last age, divided at the multiples of `every`, which need not be ages of
/// the study.
/// @throws Failure (bad_input) unless these are 2 to max_life_intervals intervals
std::vector<LifeInterval> intervals_of_life(const study::Ages& ages, double every);

/// The study in an interval of its life: machines and draws of the study at the ages of the interval.
study::Study study_in(const study::Study& study, const LifeInterval& interval);

/// The values for an interval, and what they do on machines that no search used, beside the one set of values
/// for the whole life on the same machines.
struct RetunedInterval {
  LifeInterval interval;
  Values gains;                     ///< empty if no values keep the margins
  std::vector<AgeVerdict> one_set;  ///< [age of the interval]
  std::vector<AgeVerdict> retuned;  ///< likewise; empty without gains
  std::int64_t units{0};            ///< machines
};

struct Retuning {
  double every{0.0};      ///< in the unit of ages
  std::size_t wanted{0};  ///< intervals; the budget may leave some out
  std::vector<RetunedInterval> intervals;
};

/// The first interval of those, from the last one on, whose smallest searches are affordable together; their
/// number if none is.
/// @param least trials of each interval
std::size_t first_affordable(std::span<const std::int64_t> least, std::int64_t trials);

/// The claim (claims_of_life()) that does worst: missed before undecided before met; of equals the one whose
/// lower bound is least above what is asked for.
std::size_t worst_claim_at(const study::Study& study, const AgeVerdict& age);
/// Whether every claim is shown to be met.
bool is_met_at(const AgeVerdict& age);

}  // namespace zerocount::tuning

#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runners/tuning/unit_runner.hpp"

/// Properties of the tuned values, by simulation of the units of the search. None of them is proven.
/// All functions throw trial::Interrupted and trials::Spent.
namespace zerocount::tuning {

/// The tuned study on the units of the search.
struct TunedStudy {
  const study::Study& study;
  std::span<const study::FreeParameter> free;
  const Values& gains;
  trials::Replicates units;
  std::int64_t count;  ///< of these units, that a point is simulated on
  trials::Effort effort;
};

/// Range of a free parameter, the others as tuned, in which the goal seems to be met.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
};

/// controller.delay (samples) from which on the goal seems to be lost, to 0.05; nothing up to 5 samples more.
/// @param delay of the tuned study
std::optional<double> delay_lost(const TunedStudy& tuned, double delay);

/// Rate of the goal if its band were one count wider.
std::optional<double> rate_in_wider_band(const TunedStudy& tuned);

std::vector<Room> room_of(const TunedStudy& tuned);

}  // namespace zerocount::tuning

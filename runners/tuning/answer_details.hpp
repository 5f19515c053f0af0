#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runners/tuning/units/unit_runner.hpp"

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

/// Range of a free parameter, the others as tuned, in which all goals seem to be met under all conditions.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
  /// The claims (Aim::claims) that are lost first beyond the ends; nothing at the end of the range.
  std::optional<std::size_t> lost_below{}, lost_above{};
};

/// By how much more of controller.delay (samples) a goal seems to be lost, to 0.05.
struct DelayLost {
  double more{0.0};
  std::size_t claim{0};  ///< of Aim::claims that is lost
};

/// Nothing if no goal is lost up to 5 samples more, of which every machine gets as much under each condition.
std::optional<DelayLost> delay_lost(const TunedStudy& tuned);

/// Rate of a goal if its band were one count wider, under the worst condition; nothing of a tolerance.
std::optional<double> rate_in_wider_band(const TunedStudy& tuned, std::size_t goal);

std::vector<Room> room_of(const TunedStudy& tuned);

}  // namespace zerocount::tuning

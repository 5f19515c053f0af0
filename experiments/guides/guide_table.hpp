#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/parameters/study_units.hpp"

/// Starting values for an axis whose friction nobody has measured yet.
namespace zerocount::guides {

/// Where a number comes from. Of a published number the value is; its spread may be assumed, as its source
/// then says.
enum class Origin : std::uint8_t {
  published,
  assumed,
  measured  ///< by the user
};

inline constexpr std::array<std::string_view, 3> origin_labels{"published", "assumed", "measured"};

/// One quantity of a guide and the range in which that of an unknown axis is expected.
struct GuideNumber {
  std::string_view quantity;  ///< one of the quantities below, or the dotted path of a parameter
  std::string_view unit;      ///< "1" if dimensionless
  double low{0.0};
  double high{0.0};
  Origin origin{Origin::assumed};
  std::string source;  ///< publication and place, or the reason of an assumption
};

// Quantities from which guide_manifest.hpp computes parameters.
inline constexpr std::string_view friction_coefficient = "friction coefficient";
inline constexpr std::string_view constant_resistance = "constant resistance";  ///< of seals, grease, wipers
inline constexpr std::string_view presliding_travel = "pre-sliding travel";     ///< until the guide slides
inline constexpr std::string_view softening_length = "softening length";        ///< 1/beta
inline constexpr std::string_view early_part = "early part";        ///< of friction: lost in softening
inline constexpr std::string_view creep_part = "creep part";        ///< of the travel: creep at breakaway
inline constexpr std::string_view damping_ratio = "damping ratio";  ///< of the mass on k1 + k2

/// A kind of guide. Without quantities from which parameters are computed it has the parameters of one axis.
struct Guide {
  std::string_view name;         ///< of the command line
  std::string_view description;  ///< one line
  std::string_view model;        ///< friction.model
  parameters::AxisKind axis{parameters::AxisKind::linear};
  double mass{0.0};     ///< default; kg, or kg m^2
  double preload{0.0};  ///< default; N
  std::vector<GuideNumber> numbers;
};

std::span<const Guide> guide_table();

/// @throws Failure (bad_input) with the names that there are
const Guide& guide_named(std::string_view name);

/// Range of a quantity; null if the guide does not have it.
const GuideNumber* find_number(const Guide& guide, std::string_view quantity);

/// Whether its friction grows with the load on the guide.
bool has_load(const Guide& guide);

}  // namespace zerocount::guides

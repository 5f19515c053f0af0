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

/// Origin of a number. For a published number the value is published; its spread may be assumed, and its
/// source then says so.
enum class Origin : std::uint8_t {
  published,
  assumed,
  measured  ///< measured by the user
};

inline constexpr std::array<std::string_view, 3> origin_labels{"published", "assumed", "measured"};

/// One quantity of a guide, with the range in which it is expected on an axis that was not measured.
struct GuideNumber {
  std::string_view quantity;  ///< one of the quantities below, or the dotted path of a parameter
  std::string_view unit;      ///< "1" if dimensionless
  double low{0.0};
  double high{0.0};
  Origin origin{Origin::assumed};
  std::string source;  ///< publication and place, or the reason for the assumption
};

// Quantities from which guide_manifest.hpp computes parameters.
inline constexpr std::string_view friction_coefficient = "friction coefficient";
inline constexpr std::string_view constant_resistance = "constant resistance";  ///< seals, grease, wipers
inline constexpr std::string_view presliding_travel =
    "pre-sliding travel";                                                 ///< travel until the guide slides
inline constexpr std::string_view softening_length = "softening length";  ///< 1/beta
inline constexpr std::string_view early_part =
    "early part";  ///< fraction of the breakaway force: k2/(2·beta)
inline constexpr std::string_view creep_part = "creep part";  ///< creep at breakaway, fraction of the travel
inline constexpr std::string_view damping_ratio =
    "damping ratio";  ///< damping ratio of the mass on the stiffness k1 + k2

/// A kind of guide. If it lacks the quantities from which parameters are computed, its parameters are those
/// of one particular axis.
struct Guide {
  std::string_view name;         ///< name on the command line
  std::string_view description;  ///< description in one line
  std::string_view model;        ///< value of friction.model
  parameters::AxisKind axis{parameters::AxisKind::linear};
  double mass{0.0};     ///< default mass, kg, or moment of inertia, kg m^2
  double preload{0.0};  ///< default preload, N
  std::vector<GuideNumber> numbers;
};

std::span<const Guide> guide_table();

/// The guide with this name.
/// @throws Failure (bad_input) with the existing names, if there is no such guide
const Guide& guide_named(std::string_view name);

/// Range of a quantity; null if the guide does not have it.
const GuideNumber* find_number(const Guide& guide, std::string_view quantity);

/// Whether the friction of the guide grows with the load on it.
bool has_load(const Guide& guide);

}  // namespace zerocount::guides

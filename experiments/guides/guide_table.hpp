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

/// Origin of a number about the friction of a guide. For a published number the value is published;
/// its spread may be assumed, and its source then says so.
enum class Origin : std::uint8_t {
  published,
  assumed,
  measured  ///< measured by the user on the axis
};

inline constexpr std::array<std::string_view, 3> origin_labels{"published", "assumed", "measured"};

/// One quantity of a guide, with the range in which it is expected on an axis that was not measured.
struct GuideNumber {
  /// Name of the quantity, such as "friction coefficient", or the dotted path of a parameter.
  std::string_view quantity;
  std::string_view unit;  ///< unit of the range; "1" if dimensionless
  double low{0.0};
  double high{0.0};
  Origin origin{Origin::assumed};
  std::string source;  ///< publication and place, or the reason for the assumption
};

// Quantities from which guide_manifest.hpp computes parameters.
inline constexpr std::string_view friction_coefficient = "friction coefficient";
/// Friction force that does not depend on the load: of seals, grease and wipers.
inline constexpr std::string_view constant_resistance = "constant resistance";
inline constexpr std::string_view presliding_travel =
    "pre-sliding travel";  ///< Name of the quantity: travel from rest until the guide slides.
/// Name of the quantity: length 1/beta over which the friction spring softens, beta its decay constant.
inline constexpr std::string_view softening_length = "softening length";
/// Name of the quantity: fraction k2/(2·beta) of the breakaway force, which the softening part of the spring
/// reaches.
inline constexpr std::string_view early_part = "early part";
/// Name of the quantity: creep at the breakaway force, as a fraction of the pre-sliding travel.
inline constexpr std::string_view creep_part = "creep part";
/// Name of the quantity: damping ratio of the moved mass on the initial contact stiffness k1 + k2.
inline constexpr std::string_view damping_ratio = "damping ratio";

/// A kind of linear or rotary guide (bearing), with ranges for its friction. If it lacks the quantities from
/// which parameters are computed, its parameters are those of one particular axis.
struct Guide {
  std::string_view name;         ///< name of the guide on the command line
  std::string_view description;  ///< description of the guide in one line
  std::string_view model;        ///< label of the friction law in a manifest, the value of friction.model
  parameters::AxisKind axis{parameters::AxisKind::linear};
  double mass{0.0};     ///< default mass, kg, or moment of inertia, kg m^2
  double preload{0.0};  ///< default preload, N
  std::vector<GuideNumber> numbers;
};

std::span<const Guide> guide_table();

/// The guide with this name.
/// @throws Failure (bad_input) with the existing names, if there is no such guide
const Guide& guide_named(std::string_view name);

/// The number with the range of a quantity; null if the guide does not have the quantity.
const GuideNumber* find_number(const Guide& guide, std::string_view quantity);

/// Whether the friction of the guide grows with the load on it.
bool has_load(const Guide& guide);

}  // namespace zerocount::guides

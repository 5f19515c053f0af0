#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::manifest {

/// The key beside a distribution or profile that specifies how often it is drawn.
constexpr std::string_view per_key = "per";

/// Its values, in the order of the enumeration Per.
inline constexpr std::array<std::string_view, 4> per_labels{"study", "rig", "trial", "contact"};

/// Kind of draw: a single value, or a profile along the rotor.
enum class Drawn { value, profile };

/// Default of `per`. With rigs, parameters of the machine are drawn for every rig and others for every trial.
/// Without rigs, values are drawn for every trial and profiles once for the study.
study::Per usual_per(const parameters::Parameter& parameter, Drawn drawn, bool has_rigs);

/// The value of the key `per` in `field`. Reports an unknown value or one that the parameter does not allow,
/// and returns nothing then.
std::optional<study::Per> read_per(const yaml::Field& field, const parameters::Parameter& parameter,
                                   Drawn drawn, bool has_rigs, yaml::Problems& problems);

}  // namespace zerocount::manifest

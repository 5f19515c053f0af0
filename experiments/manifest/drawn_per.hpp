#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount {

/// The key beside the form of a distribution or profile that says how often it is drawn.
constexpr std::string_view per_key = "per";

/// Its words, in the order of the enumeration Per.
std::span<const std::string_view> per_labels();

/// What is drawn: a single value, or a profile along the rotor.
enum class Drawn { value, profile };

/// How often a value of the parameter is drawn unless it says so itself. With rigs, what belongs to the
/// machine is drawn for every rig, and the rest for every trial; without them, a value for every trial and a
/// profile for the study.
Per usual_per(const Parameter& parameter, Drawn drawn, bool has_rigs);

/// The word in `field`, the value of the key `per`. Reports what is wrong, and returns nothing, where it is
/// no such word, or none that fits the parameter.
std::optional<Per> read_per(const Field& field, const Parameter& parameter, Drawn drawn, bool has_rigs,
                            Problems& problems);

}  // namespace zerocount

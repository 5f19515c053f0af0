#pragma once

#include <cstddef>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/shapes/shape_schema.hpp"

/// JSON Schemas of the values of parameters. Those of maps and lists are made of them.
namespace zerocount::manifest {

using shapes::Json;
using shapes::list_of;
using shapes::number_in;
using shapes::object_of;

/// The dotted path of the rate of an aging, as a regular expression: "friction.k1.aging".
constexpr std::string_view rate_pattern = R"(^[a-z_0-9.]+\.aging$)";

/// The rate of an aging: a number or a distribution.
Json rate_schema();

/// One definition for each distribution: `{"uniform": [low, high]}`, with or without `per` beside it.
Json definitions();

/// One value of the parameter.
Json value_schema(const parameters::Parameter& parameter);

/// The row of the parameter in the units that allow most. The schema of a section does not know the keys of
/// others.
parameters::Parameter in_widest_units(const parameters::Parameter& parameter);

/// The schema does not know a plugin's parameters: each may be any number.
parameters::Parameter plugin_value();

/// The values of a key, with its description and default.
Json key_schema(const parameters::Parameter& parameter);

}  // namespace zerocount::manifest

#pragma once

#include <cstddef>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/shapes/shape_schema.hpp"

/// JSON Schemas of the values of parameters, from which the schemas of maps and lists are built.
namespace zerocount::manifest {

using shapes::Json;
using shapes::list_of;
using shapes::number_in;
using shapes::object_of;

/// Regular expression for the dotted path of a rate at which a value changes with age, such as
/// "friction.k1.aging".
constexpr std::string_view rate_pattern = R"(^[a-z_0-9.]+\.aging$)";

/// JSON Schema of the rate at which a value changes with age: a number or a distribution.
Json rate_schema();

/// JSON Schema definitions of the distributions, one for each: `{"uniform": [low, high]}`, with or without
/// `per` (how often it is drawn) beside it.
Json definitions();

/// JSON Schema of one value of the parameter.
Json value_schema(const parameters::Parameter& parameter);

/// The table row of the parameter with the choice of units that allows the most values: a position gets SI
/// units. The schema of one section of a manifest cannot depend on keys of other sections, such as the choice
/// of units.
parameters::Parameter in_widest_units(const parameters::Parameter& parameter);

/// A table row that stands for any parameter of a user's controller (plugin), which the schema does not know:
/// any number is allowed.
parameters::Parameter plugin_value();

/// JSON Schema of the value of a key of the manifest, with its description and default.
Json key_schema(const parameters::Parameter& parameter);

}  // namespace zerocount::manifest

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

/// Regular expression for the dotted path of a rate of aging, such as "friction.k1.aging".
constexpr std::string_view rate_pattern = R"(^[a-z_0-9.]+\.aging$)";

/// Schema of a rate of aging: a number or a distribution.
Json rate_schema();

/// Definitions, one for each distribution: `{"uniform": [low, high]}`, with or without `per` beside it.
Json definitions();

/// Schema of one value of the parameter.
Json value_schema(const parameters::Parameter& parameter);

/// The row of the parameter in the units that allow the most values. The schema of one section cannot depend
/// on keys of other sections, such as the choice of units.
parameters::Parameter in_widest_units(const parameters::Parameter& parameter);

/// A row that stands for any parameter of a plugin, which the schema does not know: any number is allowed.
parameters::Parameter plugin_value();

/// Schema of the value of a key, with its description and default.
Json key_schema(const parameters::Parameter& parameter);

}  // namespace zerocount::manifest

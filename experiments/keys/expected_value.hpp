#pragma once

#include <string>

#include "experiments/distributions/distribution.hpp"
#include "experiments/parameters/parameter_table.hpp"

/// Texts of messages about the value of a parameter: what was expected in its place.
namespace zerocount::keys {

/// ", in kg m^2"; empty if the parameter is dimensionless.
std::string unit_text(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// ", in kg m^2, or a distribution, such as {uniform: [0.00044, 0.00066]}": what follows the range of a
/// number. The numbers lie around the default, where there is one.
std::string number_alternatives(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// The values that a distribution may have: "numbers greater than 0 only, in N m/rad"; or the labels.
std::string allowed_values(const parameters::Parameter& parameter, const parameters::StudyUnits& units);

/// For a normal distribution that leaves the range of its parameter, the bounded ones that are nearest to it:
/// ": {truncated_normal: {mean: 110, sd: 15, low: 65, high: 155}} or {lognormal: {median: 110, cv: 0.136}}".
/// Empty for other distributions, and where only whole numbers are allowed.
std::string cure_of_normal(const distributions::Distribution& distribution,
                           const parameters::Parameter& parameter);

}  // namespace zerocount::keys

#pragma once

#include <optional>
#include <span>
#include <string>

#include "analysis/document/description.hpp"
#include "analysis/identification/identification.hpp"

/// How estimates of parameters stand in answers.
namespace zerocount::identification {

/// An estimate: its name, key, unit and status, and its numbers in that unit.
document::Description<ParameterEstimate> estimate_description();

/// "109.98 to 110.02", with as many digits as the interval justifies; nothing if it is not estimated.
std::optional<std::string> interval_text(const ParameterEstimate& estimate);

/// A sentence on each parameter that is not identifiable, on a line of its own.
std::string missing_parameters_text(std::span<const ParameterEstimate> parameters);

/// The item of the kind of axis; the words of parameters::axis_labels.
document::Item axis_item();

/// The item of a fragment of a manifest.
document::Item fragment_item();

}  // namespace zerocount::identification

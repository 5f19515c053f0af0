#pragma once

#include <string>

#include "analysis/identification/identification.hpp"

namespace zerocount::identification {

/// The parameters, the parts of the records, the checks and the manifest fragment as text.
std::string identification_text(const Identification& identification);

/// The same as one JSON object. Numbers read back to the same double; missing values are null.
std::string identification_json(const Identification& identification);

/// The identified parameters as a fragment of a manifest, the maps `plant` and `friction`: for each estimated
/// parameter a distribution whose central 95 % are its confidence interval, for a given parameter its value,
/// for a parameter that is not identifiable a comment. Ends with a newline.
///
/// Positive parameters are lognormal, and n is a truncated normal from 1.
std::string manifest_fragment(const Identification& identification);

/// `value` with one digit more than the half-width of the parameter's interval justifies.
std::string with_digits(double value, const ParameterEstimate& parameter);

/// The distribution of one estimated parameter in the fragment.
std::string distribution_text(const ParameterEstimate& parameter);

}  // namespace zerocount::identification

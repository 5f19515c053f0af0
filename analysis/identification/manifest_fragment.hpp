#pragma once

#include <string>

#include "analysis/identification/identification.hpp"

namespace zerocount {

/// The identified parameters as a piece of a manifest: the maps `plant` and `friction`, with a distribution
/// for each parameter whose central 95 % are its confidence interval; the value itself for those that were
/// given; a comment for those that are not identifiable. Ends with a newline.
///
/// Positive parameters are lognormal, and n is a truncated normal from 1.
std::string manifest_fragment(const Identification& identification);

/// `value` with as many digits as half the width of the parameter's interval shows, and one more.
std::string with_digits(double value, const ParameterEstimate& parameter);

/// The distribution of one estimated parameter, as in the fragment.
std::string distribution_text(const ParameterEstimate& parameter);

}  // namespace zerocount

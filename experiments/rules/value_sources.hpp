#pragma once

#include <cstddef>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount::rules {

/// Source of the value of a parameter in a study.
enum class ValueSource {
  measured,  ///< the manifest gives it as a measured parameter (parameters::measured_parameters)
  sampled,   ///< drawn from a table of joint samples, such as the result of an identification
  given,     ///< the manifest gives the value itself
  assumed    ///< the value is the default
};

struct SourcedValue {
  std::size_t slot{0};
  ValueSource source{ValueSource::assumed};
};

/// The parameters on whose values the trials depend, each with the source of its value, in the order of the
/// table of parameters: all that the manifest gives, and all defaults that have an effect at some design
/// point. The command, values that follow from measured ones, and absent effects (premises_of) are not
/// included.
std::vector<SourcedValue> value_sources(const study::StudyPlan& plan);

}  // namespace zerocount::rules

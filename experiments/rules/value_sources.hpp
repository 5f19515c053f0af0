#pragma once

#include <cstddef>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount::rules {

/// The source of the value of a parameter.
enum class ValueSource {
  measured,  ///< measured parameters in the manifest (parameters::measured_parameters)
  sampled,   ///< a table of samples, such as the result of an identification
  given,     ///< the manifest
  assumed    ///< the default
};

struct SourcedValue {
  std::size_t slot{0};
  ValueSource source{ValueSource::assumed};
};

/// The parameters on whose values the trials depend, in the order of the table: all that the manifest gives,
/// and all defaults that have an effect at some design point. The command, values that follow from measured
/// ones, and absent effects (premises_of) are not included.
std::vector<SourcedValue> value_sources(const study::StudyPlan& plan);

}  // namespace zerocount::rules

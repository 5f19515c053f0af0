#pragma once

#include <cstddef>
#include <vector>

#include "experiments/study/plan.hpp"

namespace zerocount::rules {

/// Where the value of a parameter comes from.
enum class ValueSource {
  measured,  ///< the manifest gives what was measured (parameters::measured_parameters)
  sampled,   ///< a table of samples, such as those of an identification
  given,     ///< the manifest
  assumed    ///< a default
};

struct SourcedValue {
  std::size_t slot{0};
  ValueSource source{ValueSource::assumed};
};

/// The parameters whose values the trials rest on, in the order of the table: all that the manifest gives,
/// and the defaults that have an effect at some design point. Not among them are the command, values that
/// follow from measured ones, and effects that are absent (premises_of).
std::vector<SourcedValue> value_sources(const study::StudyPlan& plan);

}  // namespace zerocount::rules

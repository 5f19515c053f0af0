#pragma once

#include <span>
#include <string_view>

#include "analysis/iso230/repeatability.hpp"
#include "analysis/iso230/repeatability_trial.hpp"

/// The names of the values of ISO 230-2 in the results file, the JSON and CSV summary and the table: each
/// list here is the one source of them.
namespace zerocount::iso230 {

/// What the deviations are measured by.
struct DeviationSource {
  std::string_view name;       ///< "true" or "encoder"
  std::string_view unit;       ///< of the deviations, and of all values made of them
  std::string_view long_name;  ///< ends the long_name of a value
  Repeatability TrialRepeatability::*values;
};

/// The true position, then the encoder.
std::span<const DeviationSource> deviation_sources();

template <typename Values>
struct RepeatabilityField {
  std::string_view name;
  std::string_view symbol;  ///< of the standard
  std::string_view long_name;
  double Values::*value;
};

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields();
std::span<const RepeatabilityField<TargetRepeatability>> target_fields();

}  // namespace zerocount::iso230

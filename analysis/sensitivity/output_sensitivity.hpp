#pragma once

#include <string>
#include <vector>

#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/sensitivity/trial_outputs.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::sensitivity {

/// The values that one input had in the trials of a design point.
struct InputValues {
  std::string name;
  std::vector<double> values;  ///< [trial of the point]
};

/// What the trials of a design point were run with.
struct PointInputs {
  study::Design design{study::Design::monte_carlo};
  std::vector<std::string> factors;  ///< of the design saltelli, in its order; otherwise empty
  std::vector<InputValues> inputs;   ///< all input columns
  std::int64_t rigs{0};  ///< that the trials run on, the first ones each on another; 0: no trials share a rig
};

/// What drives one output. Of a saltelli design the indices come from whole rows, all else from the trials of
/// A and B, which are independent. Of a study with rigs they come from the first trial of every rig, because
/// the others are not independent of it. Trials without a value are left out, with their rows.
/// @param bootstrap where the rows are drawn anew from.
OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap);

/// One sentence on which factors matter. @param from_saltelli they have total indices.
std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence);

}  // namespace zerocount::sensitivity

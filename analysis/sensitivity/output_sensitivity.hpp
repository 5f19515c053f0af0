#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/sensitivity/saltelli_indices.hpp"
#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/sensitivity/trial_outputs.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::sensitivity {

/// The values that one input had in the trials of a design point.
struct InputValues {
  std::string name;
  std::vector<double> values;  ///< [trial of the point]
};

/// Unit of the sample whose inputs and outputs are compared.
enum class Subject {
  trials,
  trials_in_worlds,  ///< what differs between worlds is not among the inputs
  worlds             ///< with the means of their trials
};

/// The inputs of the trials of a design point.
struct PointInputs {
  study::Design design{study::Design::monte_carlo};
  std::vector<std::string> factors;  ///< of the design saltelli, in its order; otherwise empty
  std::vector<InputValues> inputs;   ///< all input columns
  bool correlated{false};            ///< some inputs are drawn together
  std::int64_t rigs{0};  ///< that the trials run on, the first ones each on another; 0: no trials share a rig
  Subject subject{Subject::trials};
};

/// Sensitivity of one output. Of a saltelli design the indices come from whole rows, all else from the trials
/// of A and B, which are independent. Of a study with rigs they come from the first trial of every rig,
/// because the others are not independent of it. Trials without a value are left out, with their rows.
/// @param bootstrap where the rows are drawn anew from.
OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap);

/// Which factors matter, which do not, and what the trials leave open. @param from_saltelli they have total
/// indices. With worlds there is no saltelli design to advise.
std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject);

/// The trials of a point from which the sensitivity of an output comes: those that have a value, of a
/// saltelli design those whose whole row has.
struct UsedTrials {
  std::vector<std::size_t> row_starts;   ///< of the rows of a saltelli design
  std::vector<std::size_t> independent;  ///< all, or those of A and B of a saltelli design
  std::int64_t left_out{0};              ///< without a value, or in a row with one such
  std::int64_t of_rigs{0};               ///< not looked at, because they share a rig with one that was
};

/// @param values [trial], NaN where there is none.
UsedTrials used_trials(const PointInputs& point, const std::vector<double>& values);

/// The values at these places.
std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& places);

/// The rows used.
SaltelliSample saltelli_sample(const PointInputs& point, const std::vector<double>& values,
                               const UsedTrials& used);

}  // namespace zerocount::sensitivity

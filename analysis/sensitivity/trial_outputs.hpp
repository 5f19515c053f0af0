#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/sensitivity/sensitivity.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::sensitivity {

/// One output of the trials of a design point.
struct TrialOutputs {
  std::vector<double> values;  ///< [trial of the point], in the output's unit; NaN where there is none
  std::int64_t late{0};        ///< of a time: trials with a move that counts with its duration
};

/// The output with this name.
/// @throws Failure (bad_input) where there is none; the message lists them.
SensitivityOutput find_sensitivity_output(std::string_view name, const layout::MeasureTable& measures,
                                          const goal::Question& question = {});

/// @param study of the file. @param trials the first so many of the point. @param output of
/// sensitivity_outputs().
TrialOutputs trial_outputs(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                           std::int64_t trials, const SensitivityOutput& output);

/// Duration of a move of this trial, a whole number of samples, s; of a closed loop.
double move_duration(const trial::TrialParameters& trial);

}  // namespace zerocount::sensitivity

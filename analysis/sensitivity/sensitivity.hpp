#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/measures/point_in_setting.hpp"
#include "analysis/sensitivity/sobol_indices.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/study/sampling.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/all_trials_file.hpp"

/// Sensitivity analysis: finds the random parameters of a study that influence the results of its trials.
/// Methods, formulas and sources are in README.md of this folder.
namespace zerocount::sensitivity {

/// Smallest Sobol' index at which a factor is said to matter: 1 % of the variance. A factor below it may have
/// an influence, as a long enough study would show for any factor, but the influence is too small to be worth
/// knowing.
inline constexpr double relevant_index = 0.01;

/// Smallest (partial) rank correlation ρ at which a factor is said to matter: it explains ρ² = 1 % of the
/// variance of the ranks.
inline constexpr double relevant_correlation = 0.1;

/// Sensitivity to one factor, a quantity that is drawn anew in every trial. All indices are dimensionless.
struct FactorSensitivity {
  std::string name;  ///< Dotted path of the parameter, or within_trial_factor.
  /// First-order Sobol' index: proportion of the output's variance that this factor explains alone.
  BoundedNumber first_order;
  /// Total Sobol' index, including the interactions with other factors. Only from a saltelli design.
  BoundedNumber total;
  BoundedNumber rank_correlation;  ///< Spearman's rank correlation of factor and output, in [−1, 1].
  /// Rank correlation after removing the linear influence of the other factors' ranks, in [−1, 1].
  BoundedNumber partial_rank_correlation;
  /// Change of ln(p/(1 − p)) per standard deviation of the factor, with the other factors held constant. Only
  /// for outputs that are yes or no.
  BoundedNumber log_odds;
  /// True if the factor is shown to influence the output. In a saltelli design: the lower bound of `total` is
  /// above relevant_index. Otherwise: the lower bound of `first_order` is above relevant_index, or the bounds
  /// of partial_rank_correlation exclude all values up to relevant_correlation.
  bool matters{false};
};

/// A factor for which no sensitivity is given, and the reason.
struct FactorLeftOut {
  std::string name;
  std::string reason;
};

/// Sensitivity of one output of the trials at one design point.
struct OutputSensitivity {
  std::string output;  ///< Name of the output, see sensitivity_outputs().
  std::string unit;
  /// Meaning of the output in one line, with the treatment of trials that have no value.
  std::string meaning;
  std::int64_t trials{0};            ///< Number of trials used; number of worlds if `of_worlds`.
  bool of_worlds{false};             ///< True if the values are the means of the trials of each world.
  double mean{statistics::unknown};  ///< Mean of the output, in the output's unit.
  /// Standard deviation of the output, in the output's unit.
  double standard_deviation{statistics::unknown};
  std::vector<FactorSensitivity> factors;  ///< Factors, the strongest first.
  std::vector<FactorLeftOut> left_out;
  std::vector<std::string> notes;  ///< Limitations of these numbers, a sentence each.
  /// Sentence on the factors that matter, the factors that do not, and what stays open.
  std::string conclusion;
  bool estimated{false};  ///< True if `factors` is not empty.
};

/// Sensitivity of all requested outputs at one design point. If the study has settings, in one
/// setting, so that the indices describe the trials within it.
struct PointSensitivity : measures::PointInSetting {
  std::vector<OutputSensitivity> outputs;
};

/// Sensitivity of the trials of a study.
struct StudySensitivity {
  std::string name;           ///< Name of the study.
  bool from_saltelli{false};  ///< True if the design is saltelli. The factors then have total indices.
  double confidence{0.0};     ///< Confidence of each bound by itself.
  std::vector<PointSensitivity> points;
};

/// An output of a trial whose sensitivity can be estimated.
struct SensitivityOutput {
  std::string name;
  std::string unit;
  std::string meaning;
  bool yes_or_no{false};
  /// True if the output is also known for a trial that became non-finite or was stopped.
  bool of_every_trial{false};
  /// For a time: words for a move that did not reach it and counts with its duration, such as "never
  /// arrived".
  std::string_view never{};
  /// Computes the value of a trial from its moves; NaN if it has none.
  /// @param duration gives the duration of a move of the trial, s, which is the value of a time that was not
  /// reached
  std::function<double(std::span<const trial::MoveOutcome> moves, const std::function<double()>& duration)>
      value{};
};

/// All outputs, in the order of the help. The first two are the default: `goal` and `goal_settling_time` for
/// a study with a goal, otherwise `success` and `arrival_time`. Each named goal has its own outputs:
/// `goal[large]`, `goal_settling_time[large]`.
std::vector<SensitivityOutput> sensitivity_outputs(
    const layout::MeasureTable& measures = layout::measure_table(), const goal::Question& question = {});

/// The outputs and points whose sensitivity is requested from a results file.
struct SensitivityQuestion {
  std::vector<std::int64_t> points{};  ///< Design points; empty: all.
  std::vector<std::string> outputs{};  ///< Names of sensitivity_outputs(); empty: the first two.
  double confidence{statistics::summary_confidence};  ///< Confidence of the bounds, in (0, 0.999].
  /// Number of trials of each point that are used, from the first on; a saltelli design always uses all. More
  /// trials need more time and memory. With this number the bounds of a correlation are already less than ±
  /// 0.01 wide.
  std::int64_t max_trials{100000};
  /// Called after each output of each point; may be empty.
  std::function<void(std::int64_t done, std::int64_t all)> progress{};
};

/// Computes the sensitivities from a complete results file. The result is deterministic, because the
/// resampling is seeded by the study's seed.
/// @throws Failure: bad_input for a point or an output that does not exist, or a confidence outside (0,
/// 0.999]; bad_data if the file is damaged.
StudySensitivity study_sensitivity(const reading::AllTrialsFile& file,
                                   const SensitivityQuestion& question = {});

/// Whether at least one output at one point could be estimated.
bool any_estimated(const StudySensitivity& sensitivity);

/// The answer of `sensitivity`: for each point and output a conclusion and the table of the factors.
document::AnswerDescription<StudySensitivity> sensitivity_answer();

/// One output of the trials of a design point.
struct TrialOutputs {
  /// [trial of the point] Value in the output's unit; NaN if the trial has none.
  std::vector<double> values;
  /// For a time: number of trials with a move that did not reach it and counts with its duration.
  std::int64_t late{0};
};

/// The output with this name.
/// @throws Failure (bad_input) where there is none; the message lists them.
SensitivityOutput find_sensitivity_output(std::string_view name, const layout::MeasureTable& measures,
                                          const goal::Question& question = {});

/// Values of an output in the trials of a design point.
/// @param study of the file
/// @param trials number of trials, from the first one of the point on
/// @param output one of sensitivity_outputs()
TrialOutputs trial_outputs(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                           std::int64_t trials, const SensitivityOutput& output);

/// The values that one input had in the trials of a design point.
struct InputValues {
  std::string name;
  std::vector<double> values;  ///< [trial of the point]
};

/// Kind of the sampling unit: inputs and outputs are compared between trials or between worlds.
enum class Subject {
  trials,
  /// Trials within worlds. Parameters that differ only between worlds are not among the inputs.
  trials_in_worlds,
  worlds  ///< Worlds, with the means of their trials.
};

/// The inputs of the trials of a design point.
struct PointInputs {
  study::Design design{study::Design::monte_carlo};
  /// Factors of a saltelli design, in the order of the design; otherwise empty.
  std::vector<std::string> factors;
  std::vector<InputValues> inputs;  ///< All input columns.
  bool correlated{false};           ///< True if some inputs are drawn together.
  /// Number of machines that the trials run on; 0: no trials share a machine. The first `machines` trials run
  /// on different machines.
  std::int64_t machines{0};
  Subject subject{Subject::trials};
};

/// Sensitivity of one output. In a saltelli design the indices come from whole rows, everything else from the
/// trials of A and B, which are independent. In a study with machines everything comes from the first trial
/// of every machine, because the other trials are not independent of it. Trials without a value are left out
/// together with their rows.
/// @param bootstrap random stream for resampling the rows
OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap);

/// Sentence on the factors that matter, the factors that do not, and what the trials leave open.
/// @param from_saltelli whether the factors have total indices. With worlds no saltelli design is advised,
/// because there is none.
std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject);

}  // namespace zerocount::sensitivity

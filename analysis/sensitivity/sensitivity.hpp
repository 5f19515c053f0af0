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
#include "analysis/measures/point_under_condition.hpp"
#include "analysis/sensitivity/sobol_indices.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/study/sampling.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/all_trials_file.hpp"

/// Which of the random parameters of a study drive what its trials do. Methods, formulas and sources:
/// README.md of this folder.
namespace zerocount::sensitivity {

/// The Sobol' index from which on a factor is said to matter: 1 % of the variance. Below it a factor may have
/// an influence, which a long enough study shows of any, but too little to be worth knowing.
inline constexpr double relevant_index = 0.01;

/// The (partial) rank correlation from which on a factor is said to matter: it explains ρ² = 1 % of the
/// variance of the ranks.
inline constexpr double relevant_correlation = 0.1;

/// One factor: something that is drawn anew in every trial. All indices are dimensionless.
struct FactorSensitivity {
  std::string name;  ///< dotted path of the parameter, or within_trial_factor
  /// First-order Sobol' index: proportion of the output's variance that this factor explains alone.
  BoundedNumber first_order;
  /// Total Sobol' index, with the interactions with other factors; only from a saltelli design.
  BoundedNumber total;
  BoundedNumber rank_correlation;          ///< Spearman's; in [−1, 1]
  BoundedNumber partial_rank_correlation;  ///< with the other factors' part taken out; in [−1, 1]
  /// Change of ln(p/(1 − p)) over one standard deviation of the factor, the others held; only of outputs that
  /// are yes or no.
  BoundedNumber log_odds;
  /// The lower bound of total is above relevant_index; where the design is not saltelli, that of first_order
  /// is, or the bounds of partial_rank_correlation exclude all up to relevant_correlation.
  bool matters{false};
};

/// A factor that has no row, and why.
struct FactorLeftOut {
  std::string name;
  std::string reason;
};

/// Sensitivity of one output of the trials at one design point.
struct OutputSensitivity {
  std::string output;  ///< as sensitivity_outputs() has it
  std::string unit;
  std::string meaning;               ///< one line, with what was done about trials that have no value
  std::int64_t trials{0};            ///< used; worlds where `of_worlds`
  bool of_worlds{false};             ///< of the means of the trials of each world
  double mean{statistics::unknown};  ///< of the output, in its unit
  double standard_deviation{statistics::unknown};  ///< of the output, in its unit
  std::vector<FactorSensitivity> factors;          ///< strongest first
  std::vector<FactorLeftOut> left_out;
  std::vector<std::string> notes;  ///< what limits these numbers, a sentence each
  std::string conclusion;          ///< which factors matter, which do not, and what stays open
  bool estimated{false};           ///< there is something in `factors`
};

/// All outputs asked for, at one design point; under one of the conditions where there are any, so that the
/// indices say what drives the trials within it.
struct PointSensitivity : measures::PointUnderCondition {
  std::vector<OutputSensitivity> outputs;
};

/// Sensitivity of the trials of a study.
struct StudySensitivity {
  std::string name;           ///< of the study
  bool from_saltelli{false};  ///< its design is saltelli, and the factors have total indices
  double confidence{0.0};     ///< of all bounds, each by itself
  std::vector<PointSensitivity> points;
};

/// An output of a trial whose sensitivity can be estimated.
struct SensitivityOutput {
  std::string name;
  std::string unit;
  std::string meaning;
  bool yes_or_no{false};
  bool of_every_trial{false};  ///< also known where the motion was lost, or the trial was stopped
  std::string_view never{};    ///< of a time: what a move did that counts with its duration, "never arrived"
  /// The value of the trial with these moves; NaN where it has none.
  /// @param duration of a move of the trial, s: for a time that was not reached
  std::function<double(std::span<const trial::MoveOutcome> moves, const std::function<double()>& duration)>
      value{};
};

/// All of them, in the order of the help. The first two are asked about unless told otherwise: `goal` and
/// `goal_settling_time` of a study with a goal, `success` and `arrival_time` without one. Each of the goals
/// with names has its own: `goal[large]`, `goal_settling_time[large]`.
std::vector<SensitivityOutput> sensitivity_outputs(
    const layout::MeasureTable& measures = layout::measure_table(), const goal::Question& question = {});

/// The request for a file.
struct SensitivityQuestion {
  std::vector<std::int64_t> points{};                 ///< empty: all
  std::vector<std::string> outputs{};                 ///< of sensitivity_outputs(); empty: the first two
  double confidence{statistics::summary_confidence};  ///< in (0, 0.999]
  /// The first so many trials of a point are used, of a saltelli design all: more need more time and memory,
  /// and with these the bounds of a correlation are less than ± 0.01 wide.
  std::int64_t max_trials{100000};
  /// Called after each output of each point; may be empty.
  std::function<void(std::int64_t done, std::int64_t all)> progress{};
};

/// Answers from a complete results file. Deterministic: the resampling is seeded by the study's seed.
/// @throws Failure: bad_input for a point or an output that there is not, or a confidence outside (0, 0.999];
/// bad_data where the file is damaged.
StudySensitivity study_sensitivity(const reading::AllTrialsFile& file,
                                   const SensitivityQuestion& question = {});

/// Whether at least one output at one point could be estimated.
bool any_estimated(const StudySensitivity& sensitivity);

/// The answer of `sensitivity`: for each point and output a conclusion and the table of the factors.
document::AnswerDescription<StudySensitivity> sensitivity_answer();

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
  std::int64_t machines{
      0};  ///< that the trials run on, the first ones each on another; 0: no trials share a machine
  Subject subject{Subject::trials};
};

/// Sensitivity of one output. Of a saltelli design the indices come from whole rows, all else from the trials
/// of A and B, which are independent. Of a study with machines they come from the first trial of every
/// machine, because the others are not independent of it. Trials without a value are left out, with their
/// rows.
/// @param bootstrap where the rows are drawn anew from.
OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap);

/// Which factors matter, which do not, and what the trials leave open. @param from_saltelli they have total
/// indices. With worlds there is no saltelli design to advise.
std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject);

}  // namespace zerocount::sensitivity

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/point_in_setting.hpp"
#include "analysis/trials/sensitivity/sobol_indices.hpp"
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

/// Sensitivity of an output to one factor: a parameter that is drawn anew in every trial. All indices are
/// dimensionless.
struct FactorSensitivity {
  /// Dotted path of the parameter, or within_trial_factor for what is random within a trial, such as noise.
  std::string name;
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

/// A parameter for which no sensitivity is given, and the reason.
struct FactorLeftOut {
  std::string name;
  std::string reason;
};

/// Sensitivity of one output of the trials at one design point.
struct OutputSensitivity {
  std::string output;  ///< Name of the output, see sensitivity_outputs().
  std::string unit;
  /// Meaning of the output in one line, including how trials without a value are treated.
  std::string meaning;
  std::int64_t trials{0};  ///< Number of trials used; number of worlds if `of_worlds`.
  /// True if the values are means over the trials of each world (one draw of what all machines share), not
  /// values of trials.
  bool of_worlds{false};
  double mean{statistics::unknown};  ///< Mean of the output, in the output's unit.
  /// Standard deviation of the output, in the output's unit.
  double standard_deviation{statistics::unknown};
  /// Sensitivity to each factor (random parameter), the strongest first.
  std::vector<FactorSensitivity> factors;
  std::vector<FactorLeftOut> left_out;
  std::vector<std::string> notes;  ///< Limitations of these numbers, one sentence each, for the user.
  /// Sentence on the factors that matter, the factors that do not, and what stays open.
  std::string conclusion;
  bool estimated{false};  ///< True if the sensitivity could be estimated, so that `factors` is not empty.
};

/// Sensitivity of all requested outputs at one design point. If the study has settings (conditions at ages),
/// it is that of the trials within one setting.
struct PointSensitivity : measures::PointInSetting {
  std::vector<OutputSensitivity> outputs;
};

/// Sensitivity of the trials' outputs to the random parameters of a study, at each design point.
struct StudySensitivity {
  std::string name;           ///< Name of the study.
  bool from_saltelli{false};  ///< True if the design is saltelli. The factors then have total indices.
  double confidence{0.0};     ///< Confidence level of each pair of bounds by itself, in (0, 1).
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
  /// For an output that is a time: words for a move in which the event did not come, so that the duration of
  /// the move is counted: "never arrived".
  std::string_view never{};
  /// Computes the output of a trial from its moves; NaN if the trial has none.
  /// @param duration returns the duration of a move of the trial, s, which is counted as the time of an event
  /// that did not come
  std::function<double(std::span<const trial::MoveOutcome> moves, const std::function<double()>& duration)>
      value{};
};

/// All outputs whose sensitivity can be requested, in the order in which the help lists them. The first two
/// are the default: `goal` and `goal_settling_time` for a study with a goal, otherwise `success` and
/// `arrival_time`. Each named goal has its own outputs: `goal[large]`, `goal_settling_time[large]`.
std::vector<SensitivityOutput> sensitivity_outputs(
    const layout::MeasureTable& measures = layout::measure_table(), const goal::Question& question = {});

/// The outputs and points whose sensitivity is requested from a results file.
struct SensitivityQuestion {
  std::vector<std::int64_t> points{};  ///< Indices of the design points; empty: all points.
  /// Names of the outputs, see sensitivity_outputs(); empty: the first two of them.
  std::vector<std::string> outputs{};
  double confidence{statistics::summary_confidence};  ///< Confidence of the bounds, in (0, 0.999].
  /// Number of trials of each point that are used, from the first on. A saltelli design always uses all. More
  /// trials need more time and memory. With this number the bounds of a correlation are already less than ±
  /// 0.01 wide.
  std::int64_t max_trials{100000};
  /// Called after each output of each point with the number of results done and of all; may be empty.
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

/// Values of one output in the trials of a design point.
struct TrialOutputs {
  /// [trial of the point] Value in the output's unit; NaN if the trial has none.
  std::vector<double> values;
  /// For an output that is a time: number of trials with a move in which the event did not come; its duration
  /// is counted.
  std::int64_t late{0};
};

/// The output with this name, among sensitivity_outputs().
/// @throws Failure (bad_input) if there is none; the message lists the outputs.
SensitivityOutput find_sensitivity_output(std::string_view name, const layout::MeasureTable& measures,
                                          const goal::Question& question = {});

/// Values of an output in the trials of a design point.
/// @param study study of the file
/// @param trials number of trials, from the first one of the point on
/// @param output one of sensitivity_outputs()
TrialOutputs trial_outputs(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                           std::int64_t trials, const SensitivityOutput& output);

/// The values that one input had in the trials of a design point.
struct InputValues {
  std::string name;
  std::vector<double> values;  ///< [trial of the point] Value of the input, in its unit.
};

/// Kind of the unit of observation whose inputs and outputs are related: a trial or a world (one draw of what
/// all machines share and nobody knows).
enum class Subject {
  trials,
  /// Trials of a study with worlds. Parameters that differ only between worlds are not among the inputs.
  trials_in_worlds,
  worlds  ///< Worlds; their outputs are means over their trials.
};

/// The inputs of the trials of a design point.
struct PointInputs {
  study::Design design{study::Design::monte_carlo};
  /// Factors of a saltelli design, in the order of the design; otherwise empty.
  std::vector<std::string> factors;
  /// All inputs: random or varied parameters, with their values in each trial.
  std::vector<InputValues> inputs;
  bool correlated{false};  ///< True if some parameters are drawn jointly, so that they are not independent.
  /// Number of machines that the trials run on; 0: no trials share a machine. The first `machines` trials run
  /// on different machines.
  std::int64_t machines{0};
  Subject subject{Subject::trials};
};

/// Sensitivity of one output to the inputs. In a saltelli design the Sobol' indices come from whole rows,
/// everything else from the trials of A and B, which are independent. In a study with machines everything
/// comes from the first trial of every machine, because the other trials are not independent of it. Trials
/// without a value are left out together with their rows.
/// @param trials values of the output
/// @param bootstrap random stream that selects the resampled rows
OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap);

/// Sentence on the factors that matter, the factors that do not, and what the trials leave open.
/// @param from_saltelli true if the factors have total Sobol' indices from a saltelli design
/// @param subject what the values describe; for a study with worlds the sentence does not advise a saltelli
/// design, because such a study cannot have one
std::string sensitivity_conclusion(const OutputSensitivity& sensitivity, bool from_saltelli,
                                   double confidence, Subject subject);

}  // namespace zerocount::sensitivity

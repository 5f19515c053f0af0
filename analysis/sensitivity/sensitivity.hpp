#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/question.hpp"
#include "analysis/sensitivity/bounded_number.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/unknown.hpp"
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
struct PointSensitivity {
  std::int64_t point{0};
  std::string label;                       ///< with the condition, if there is one
  std::optional<std::string> condition{};  ///< that its trials are under
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
/// `goal_settling_time` of a study with a goal, `success` and `settling_time` without one. Each of the goals
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

}  // namespace zerocount::sensitivity

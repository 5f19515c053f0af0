#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/document/figure.hpp"
#include "analysis/measures/goal_counts.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "runners/rare/estimator.hpp"
#include "runners/rare/proposal.hpp"
#include "runners/trials/effort.hpp"

/// Probability of a rare failure in the moves of a study: trials given by random coordinates, the results
/// file, and the report.
namespace zerocount::rare {

/// Trials to which a probability refers. A probability over all worlds would average over unknowns, and one
/// over all settings would average over settings that every machine must bear.
struct Population {
  std::int64_t point{0};                  ///< Design point.
  std::optional<std::int64_t> world{};    ///< World, if the study has worlds.
  std::optional<std::int64_t> setting{};  ///< Setting, if the study has settings.

  bool operator==(const Population&) const = default;
};

/// The event whose probability is sought, and the trials that decide it. Each trial has a machine of its own.
struct Question {
  study::Study whole;  ///< Study of the manifest.
  study::Study study;  ///< Study in the setting of the population.
  Population of;       ///< Trials to which the probability refers.
  measures::MoveEvent event;
  std::vector<randomness::RandomCoordinate> coordinates;
  TrialSpace space;  ///< Space of the coordinates.
};

Question question_of(study::Study study, const Population& of, measures::MoveEvent event);

/// Random numbers of a trial.
study::GivenDraws draws_at(const Question& question, const Trial& trial);

/// Parameters and inputs of a trial.
study::StudyTrial trial_at(const Question& question, const Trial& trial);

/// Sets the result of a trial: the proportion of judged moves to which the event happens, and the scores
/// (measures::move_scores).
void set_result(Trial& trial, const Question& question, std::span<const trial::MoveOutcome> moves);

/// Runs trials on all cores.
/// @param draws [trial] random numbers; empty: draws_at()
/// @throws trial::Interrupted
void run_trials(const Question& question, std::span<Trial> trials, const trials::Effort& effort,
                std::vector<study::GivenDraws> draws = {});

/// Quantiles of an input.
struct InputRange {
  double low{0.0};     ///< 5 % quantile.
  double median{0.0};  ///< Median.
  double high{0.0};    ///< 95 % quantile.
};

/// Comparison of an input between failing trials and all trials.
struct FailureInput {
  std::string name;  ///< Dotted path.
  std::string unit;
  /// Mean normal score of the input over the failures: number of standard deviations by which failures lie
  /// above the median. If a single random coordinate decides the input, the coordinate is the score.
  /// Otherwise the score follows from the rank among some thousand trials.
  double shift{0.0};
  InputRange usual;     ///< Quantiles in all trials.
  InputRange failures;  ///< Quantiles in failing trials.
};

/// Inputs that differ between trials, sorted by decreasing absolute shift. Empty without a failure.
std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state);

/// Failure rates of the machines on which failures occur. They show whether few machines carry the
/// probability.
struct CarryingMachines {
  std::int64_t examined{0};        ///< Number of examined machines, drawn from the failures.
  std::int64_t moves_each{0};      ///< Number of trials of each machine, with new moves.
  double median_rate{0.0};         ///< Median over these machines of the proportion of failing moves.
  double mostly_failing{0.0};      ///< Proportion of failures on machines that fail in most of their moves.
  double probability_of_one{0.0};  ///< Probability that a machine fails in most of its moves.
};

/// Runs further moves of machines that failed. The machines are drawn by the weights of their failures.
/// Nothing without a failure, or if random numbers of machine and move cannot be separated.
/// @throws trial::Interrupted
std::optional<CarryingMachines> carrying_machines(const Question& question, const EstimatorState& state,
                                                  double probability, const trials::Effort& effort);

/// Settings of run_rare().
struct RareSettings {
  std::filesystem::path output;  ///< File of the weighted trials; empty: no file is written.
  double confidence{statistics::summary_confidence};
  double ratio{2.0};                       ///< Wanted ratio of the bounds, high / low.
  std::optional<std::int64_t> max_trials;  ///< Maximum number of trials of this run.
  std::optional<double> seconds;           ///< Time limit of this run, s.
  bool quiet{false};
  bool force{false};  ///< Whether to replace an existing file instead of resuming or refusing it.
};

struct RareAnswer {
  const Question& question;
  RareSettings settings;
  EstimatorState state{};
  Estimate estimate{};
  std::vector<FailureInput> inputs{};
  std::optional<CarryingMachines> machines{};
  double seconds{0.0};  ///< Time that all runs took together, s.
};

/// Estimates the probability of the event, and writes the results file. If the file exists and answers the
/// same question, the estimate is resumed from it.
/// @param question must outlive the answer
/// @throws Failure: bad_input if the file exists and answers another question; machine_failed; interrupted,
/// after the trials drawn so far are written
RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop);

/// Description of the answer: the probability first, then its assumptions, then what failures have in common.
document::AnswerDescription<RareAnswer> rare_answer();

/// Figures of the ranges of the inputs, in failures and in all trials.
std::vector<document::Figure> rare_figures(const std::vector<FailureInput>& inputs);

/// Contents of a file of `zerocount rare`: header, question, and state of the estimate.
struct RareRecord {
  layout::FileHeader header;
  Population of;
  std::string event;  ///< MoveEvent::text
  EstimatorState state;
  double seconds{0.0};  ///< Time that the estimate took so far, s.
};

/// Writes the file of an answer. It has the header and the manifest; /estimate, JSON with the learned
/// proposal and the answer; and /drawn, with a row for each trial drawn from the proposal: its weight, inputs
/// and coordinates.
/// @throws Failure (machine_failed)
void write_rare_file(const RareAnswer& answer);

/// Reads a file of write_rare_file().
/// @throws Failure: bad_data for a damaged file, ForeignFile for another format
RareRecord read_rare_file(const std::filesystem::path& path);

/// Whether a file was written by write_rare_file().
/// @throws Failure as read_rare_file
bool is_rare_file(const std::filesystem::path& path);

/// Question that a file answers.
/// @param plugin the user's controller; null: the recorded one
/// @throws Failure as layout::recorded_study
Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin = nullptr);

}  // namespace zerocount::rare

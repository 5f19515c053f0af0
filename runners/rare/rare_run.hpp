#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/figure.hpp"
#include "analysis/trials/measures/move_event.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "runners/rare/estimator.hpp"
#include "runners/rare/proposal.hpp"
#include "runners/trials/effort.hpp"

/// Estimates the probability of a rare failure in the moves of a study. The trials are functions of random
/// coordinates. Also has the results file and the report.
namespace zerocount::rare {

/// Trials to which a probability refers: one design point, one world, one setting (a condition at an age).
/// World: one draw of the values that all machines share and nobody knows. A probability over all worlds
/// would average over unknowns, and one over all settings would average over settings that every machine must
/// bear.
struct Population {
  std::int64_t point{0};  ///< Index of the design point.
  /// Index of the world (one draw of the values that all machines share and nobody knows); nothing if the
  /// study has no worlds.
  std::optional<std::int64_t> world{};
  /// Index of the setting (a condition at an age); nothing if the study has no settings.
  std::optional<std::int64_t> setting{};

  bool operator==(const Population&) const = default;
};

/// The event whose probability is sought, and the trials that decide it. Each trial has a machine of its own.
struct Question {
  study::Study whole;  ///< Study of the manifest, in all its settings (conditions at ages).
  study::Study study;  ///< Study restricted to the setting of the population (a condition at an age).
  Population of;       ///< Population of trials to which the probability refers.
  measures::MoveEvent event;
  std::vector<randomness::RandomCoordinate> coordinates;
  TrialSpace space;  ///< Number of coordinates of a trial, and its discrete draws.
};

Question question_of(study::Study study, const Population& of, measures::MoveEvent event);

/// Random numbers of a trial, made from its coordinates Trial::z and its Trial::number.
study::GivenDraws draws_at(const Question& question, const Trial& trial);

/// Parameters and drawn inputs of a trial, made from its coordinates and number.
study::StudyTrial trial_at(const Question& question, const Trial& trial);

/// Sets the result of a simulated trial: the proportion of judged moves to which the event happens
/// (Trial::failed), and the scores (measures::move_scores).
/// @param moves measures of the trial's moves
void set_result(Trial& trial, const Question& question, std::span<const trial::MoveOutcome> moves);

/// Simulates trials on all cores, and sets their results (set_result()).
/// @param draws [trial] random numbers of the trial; empty: draws_at() gives them
/// @throws trial::Interrupted if the time of `effort` is over or a stop is requested
void run_trials(const Question& question, std::span<Trial> trials, const trials::Effort& effort,
                std::vector<study::GivenDraws> draws = {});

/// Quantiles of an input over a set of trials, in the unit of the input.
struct InputRange {
  double low{0.0};     ///< 5 % quantile, in the unit of the input.
  double median{0.0};  ///< Median, in the unit of the input.
  double high{0.0};    ///< 95 % quantile, in the unit of the input.
};

/// Comparison of the distribution of an input in failing trials with its distribution in all trials.
struct FailureInput {
  std::string name;  ///< Dotted path of the input.
  std::string unit;
  /// Mean normal score of the input over the failures: number of standard deviations by which failures lie
  /// above the median. If a single random coordinate decides the input, the coordinate is the score.
  /// Otherwise the score follows from the rank among some thousand trials.
  double shift{0.0};
  InputRange usual;     ///< Quantiles of the input in all trials.
  InputRange failures;  ///< Quantiles of the input in failing trials.
};

/// Comparisons of all inputs that differ between trials, sorted by decreasing absolute `shift`. Empty without
/// a failure.
std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state);

/// Failure rates of the machines on which failures occur. They show whether few machines carry the
/// probability.
struct CarryingMachines {
  std::int64_t examined{0};  ///< Number of examined machines, drawn from those on which failures occurred.
  /// Number of trials that each examined machine runs again, each with new moves.
  std::int64_t moves_each{0};
  double median_rate{0.0};  ///< Median of the proportion of failing moves, over the examined machines.
  /// Proportion of all failures that occur on machines which fail in most of their moves.
  double mostly_failing{0.0};
  double probability_of_one{0.0};  ///< Probability that a machine drawn at random fails in most of its moves.
};

/// Runs further moves of machines on which failures occurred. The machines are drawn by the weights of their
/// failures. Nothing without a failure, or if a value of the machine is correlated with one of the move.
/// @param probability estimated probability of a failing move
/// @throws trial::Interrupted if the time of `effort` is over or a stop is requested
std::optional<CarryingMachines> carrying_machines(const Question& question, const EstimatorState& state,
                                                  double probability, const trials::Effort& effort);

/// Settings of an estimate of the probability of a rare failure (run_rare()).
struct RareSettings {
  std::filesystem::path output;  ///< Results file, with the weighted trials; empty: no file is written.
  double confidence{statistics::summary_confidence};
  double ratio{2.0};  ///< Wanted ratio of the confidence bounds, high / low.
  /// Maximum number of trials that this run simulates; nothing: no limit.
  std::optional<std::int64_t> max_trials;
  std::optional<double> seconds;  ///< Time limit of this run, s; nothing: no limit.
  bool quiet{false};
  /// Whether to replace an existing file. False: the estimate in it is resumed, or the file is refused.
  bool force{false};
};

struct RareAnswer {
  const Question& question;
  RareSettings settings;
  EstimatorState state{};
  ProbabilityEstimate estimate{};
  std::vector<FailureInput> inputs{};
  std::optional<CarryingMachines> machines{};
  double seconds{0.0};  ///< Time that this run and the earlier runs which it resumes took together, s.
};

/// Estimates the probability of the event, and writes the results file. If the file exists and answers the
/// same question, the estimate is resumed from it.
/// @param question must outlive the answer
/// @throws Failure: bad_input if the file exists and answers another question; machine_failed; interrupted,
/// after the trials drawn so far are written
RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop);

/// Description of the answer of `zerocount rare`: the probability first, then its assumptions, then what the
/// failures have in common.
document::AnswerDescription<RareAnswer> rare_answer();

/// Figures that compare the ranges of the inputs in failing trials with those in all trials.
std::vector<document::Figure> rare_figures(const std::vector<FailureInput>& inputs);

/// Contents of a results file of `zerocount rare`: header, event and population, and state of the estimate.
struct RareRecord {
  layout::FileHeader header;
  Population of;
  std::string event;  ///< MoveEvent::text, the event whose probability is sought.
  EstimatorState state;
  double seconds{0.0};  ///< Time that all runs of the estimate took so far, s.
};

/// Writes the results file of `zerocount rare`. It has the header and the manifest; /estimate, JSON with the
/// learned proposal and the answer; and /drawn, with a row for each trial drawn from the proposal: its
/// weight, inputs and coordinates.
/// @throws Failure (machine_failed) if the file cannot be written
void write_rare_file(const RareAnswer& answer);

/// Reads a results file of `zerocount rare`, written by write_rare_file().
/// @throws Failure: bad_data for a damaged file, ForeignFile for another format
RareRecord read_rare_file(const std::filesystem::path& path);

/// Whether a file is a results file of `zerocount rare`, written by write_rare_file().
/// @throws Failure as read_rare_file
bool is_rare_file(const std::filesystem::path& path);

/// Question (event and population) that a file of `zerocount rare` answers.
/// @param path path of the file, for messages
/// @param plugin the user's controller; null: the recorded one
/// @throws Failure as layout::recorded_study
Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin = nullptr);

}  // namespace zerocount::rare

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

/// The probability of a rare failure of the moves of a study: trials by their random coordinates, the results
/// file, and the report.
namespace zerocount::rare {

/// The trials of which a probability is: a probability over all worlds, or conditions, would be an average
/// over what nobody knows, or over what every machine bears.
struct Population {
  std::int64_t point{0};
  std::optional<std::int64_t> world{};      ///< of a study with worlds
  std::optional<std::int64_t> condition{};  ///< of a study with conditions

  bool operator==(const Population&) const = default;
};

/// The event whose probability is sought, and the trials that decide it: each on a machine of its own.
struct Question {
  study::Study whole;  ///< of the manifest
  study::Study study;  ///< under the condition
  Population of;
  measures::MoveEvent event;
  std::vector<randomness::RandomCoordinate> coordinates;
  TrialSpace space;  ///< of the coordinates
};

Question question_of(study::Study study, const Population& of, measures::MoveEvent event);

/// The random numbers of a trial.
study::GivenDraws draws_at(const Question& question, const Trial& trial);

/// The parameters and inputs of a trial.
study::StudyTrial trial_at(const Question& question, const Trial& trial);

/// Sets the proportion of the moves that are asked to which the event happens, and the scores
/// measures::move_scores.
void set_result(Trial& trial, const Question& question, std::span<const trial::MoveOutcome> moves);

/// Runs trials on all cores. @param draws of each trial; draws_at() where there are none
/// @throws trial::Interrupted
void run_trials(const Question& question, std::span<Trial> trials, const trials::Effort& effort,
                std::vector<study::GivenDraws> draws = {});

/// Quantiles of an input.
struct InputRange {
  double low{0.0};  ///< 5 %
  double median{0.0};
  double high{0.0};  ///< 95 %
};

/// An input of the trials: what it is in those that fail.
struct FailureInput {
  std::string name;  ///< dotted path
  std::string unit;
  /// Mean over the failures of the input's normal score: how many standard deviations failures lie above the
  /// median. Of a random coordinate it is that; of another input it follows from the rank among some thousand
  /// trials.
  double shift{0.0};
  InputRange usual;     ///< of all trials
  InputRange failures;  ///< of those that fail
};

/// The inputs that differ between trials; those that failure shifts most come first. Empty without a failure.
std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state);

/// How often the machines fail that carry the probability.
struct CarryingMachines {
  std::int64_t examined{0};    ///< machines, drawn from the failures
  std::int64_t moves_each{0};  ///< trials of each, with new moves
  double median_rate{0.0};     ///< of their proportion of failing moves
  double mostly_failing{0.0};  ///< proportion of the failures on machines that fail in most of their moves
  double probability_of_one{0.0};  ///< that a machine is one of these
};

/// Runs further moves of machines that failed, drawn by the weights of the failures. Nothing without a
/// failure, or where machines and moves are not told apart.
/// @throws trial::Interrupted
std::optional<CarryingMachines> carrying_machines(const Question& question, const EstimatorState& state,
                                                  double probability, const trials::Effort& effort);

struct RareSettings {
  std::filesystem::path output;  ///< of the weighted trials; empty: none is written
  double confidence{statistics::summary_confidence};
  double ratio{2.0};                       ///< wanted of the bounds, high / low
  std::optional<std::int64_t> max_trials;  ///< of this run
  std::optional<double> seconds;           ///< of this run
  bool quiet{false};
  bool force{false};  ///< replace a file that answers another question
};

struct RareAnswer {
  const Question& question;
  RareSettings settings;
  EstimatorState state{};
  Estimate estimate{};
  std::vector<FailureInput> inputs{};
  std::optional<CarryingMachines> machines{};
  double seconds{0.0};  ///< of all runs
};

/// Estimates the probability of the event, and writes the results file. Goes on from an earlier file that
/// answers the same question.
/// @param question outlives the answer
/// @throws Failure: bad_input if the file exists and answers another question; machine_failed; interrupted,
/// after the trials drawn so far are written
RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop);

/// The probability first, then what it rests on, and what failures have in common.
document::AnswerDescription<RareAnswer> rare_answer();

/// The ranges of the inputs in failures and in all trials.
std::vector<document::Figure> rare_figures(const std::vector<FailureInput>& inputs);

/// The contents of a file of `zerocount rare`: the header, the question, and the state of the estimate.
struct RareRecord {
  layout::FileHeader header;
  Population of;
  std::string event;  ///< MoveEvent::text
  EstimatorState state;
  double seconds{0.0};  ///< that the estimate took so far
};

/// Writes the answer's file: the header and the manifest, /estimate (JSON: what was learned and the answer),
/// and /drawn, a row for each trial drawn from the proposal with its weight, inputs and coordinates.
/// @throws Failure (machine_failed)
void write_rare_file(const RareAnswer& answer);

/// @throws Failure: bad_data for a damaged file, ForeignFile for another format
RareRecord read_rare_file(const std::filesystem::path& path);

/// Whether a file was written by write_rare_file(). @throws Failure as read_rare_file
bool is_rare_file(const std::filesystem::path& path);

/// The question that the file answers.
/// @param plugin the user's controller; null: as recorded
/// @throws Failure as layout::recorded_study
Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin = nullptr);

}  // namespace zerocount::rare

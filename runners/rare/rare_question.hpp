#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/measures/move_event.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/study.hpp"
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

}  // namespace zerocount::rare

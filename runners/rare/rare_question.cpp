#include "runners/rare/rare_question.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/parallel/parallel.hpp"
#include "analysis/statistics/unknown.hpp"
#include "experiments/study/condition_study.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::rare {

Question question_of(study::Study study, const Population& of, measures::MoveEvent event) {
  study::Study alone = under_condition(study, of.condition.value_or(0));
  Question question{std::move(study), std::move(alone), of, std::move(event), {}, {}};
  question.coordinates = randomness::random_coordinates(question.study, of.point);
  question.space = trial_space(question.coordinates.size(),
                               randomness::discrete_draws(question.study, of.point, question.coordinates));
  return question;
}

study::GivenDraws draws_at(const Question& question, const TrialPoint& trial) {
  study::GivenDraws draws = randomness::draws_at(question.study, question.coordinates, trial.z, trial.number);
  draws.world = question.of.world;
  return draws;
}

study::StudyTrial trial_at(const Question& question, const TrialPoint& trial) {
  return study::study_trial(question.study, question.of.point, 0, draws_at(question, trial));
}

PointResult result_of(const Question& question, std::span<const trial::MoveOutcome> moves) {
  PointResult result{0.0, std::vector<double>(measures::move_scores.size(), statistics::unknown)};
  std::int64_t failed = 0;
  std::int64_t asked = 0;
  for (const trial::MoveOutcome& move : moves) {
    if (!measures::is_asked(question.event, move)) continue;
    ++asked;
    failed += measures::happens(question.event, move) ? 1 : 0;
    for (std::size_t i = 0; i < result.scores.size(); ++i)
      result.scores[i] =
          std::fmax(result.scores[i], measures::score_of(measures::move_scores[i], question.event, move));
  }
  result.failed = static_cast<double>(failed) / static_cast<double>(asked);
  return result;
}

std::vector<PointResult> run_trials(const Question& question, std::span<const study::GivenDraws> draws,
                                    const trials::Effort& effort) {
  const auto draw = [&](std::int64_t i) {
    const study::GivenDraws& given = draws[static_cast<std::size_t>(i)];
    return study::study_trial(question.study, question.of.point, 0, given).parameters;
  };
  return trials::results_of(
      std::ssize(draws), trials::block_for_lanes(std::ssize(draws)), draw, effort,
      [&](const trial::TrialOutcome& outcome) { return result_of(question, outcome.moves); });
}

Simulation simulation_of(const Question& question, const trials::Effort& effort) {
  return [&question, effort](std::span<const TrialPoint> points) {
    std::vector<study::GivenDraws> draws(points.size());
    parallel::for_each_index(
        points.size(), [&](std::size_t i) { draws[i] = draws_at(question, points[i]); }, "draw");
    return run_trials(question, draws, effort);
  };
}

}  // namespace zerocount::rare

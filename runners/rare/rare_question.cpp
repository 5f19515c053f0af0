#include "runners/rare/rare_question.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/statistics/unknown.hpp"
#include "core/batch/batch.hpp"
#include "runners/study_run/parallel_trials.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t trials_at_once = 128;  // by one thread

void run_part(const Question& question, std::span<const study::GivenDraws> draws,
              std::span<PointResult> results, batch::BatchEngine& engine, const std::stop_token& stop) {
  std::vector<trial::TrialParameters> trials;
  trials.reserve(draws.size());
  for (const study::GivenDraws& one : draws)
    trials.push_back(study::study_trial(question.study, question.point, 0, one).parameters);
  const std::vector<trial::TrialOutcome> outcomes = study_run::outcomes_of(trials, engine, stop);
  for (std::size_t i = 0; i < outcomes.size(); ++i) results[i] = result_of(question, outcomes[i].moves);
}

}  // namespace

Question question_of(study::Study study, std::int64_t point, std::optional<std::int64_t> world,
                     measures::MoveEvent event) {
  Question question{std::move(study), point, world, std::move(event), {}, {}};
  question.coordinates = study::random_coordinates(question.study, point);
  question.space = trial_space(question.coordinates.size(),
                               study::discrete_draws(question.study, point, question.coordinates));
  return question;
}

study::GivenDraws draws_at(const Question& question, const TrialPoint& trial) {
  study::GivenDraws draws = study::draws_at(question.study, question.coordinates, trial.z, trial.number);
  draws.world = question.world;
  return draws;
}

study::StudyTrial trial_at(const Question& question, const TrialPoint& trial) {
  return study::study_trial(question.study, question.point, 0, draws_at(question, trial));
}

PointResult result_of(const Question& question, std::span<const trial::MoveOutcome> moves) {
  PointResult result{0.0, std::vector<double>(measures::move_scores.size(), statistics::unknown)};
  std::int64_t failed = 0;
  for (const trial::MoveOutcome& move : moves) {
    failed += measures::happens(question.event, move) ? 1 : 0;
    for (std::size_t i = 0; i < result.scores.size(); ++i)
      result.scores[i] =
          std::fmax(result.scores[i], measures::score_of(measures::move_scores[i], question.event, move));
  }
  result.failed = static_cast<double>(failed) / static_cast<double>(moves.size());
  return result;
}

std::vector<PointResult> run_trials(const Question& question, std::span<const study::GivenDraws> draws,
                                    const std::stop_token& stop) {
  std::vector<PointResult> results(draws.size());
  const std::size_t parts = (draws.size() + trials_at_once - 1) / trials_at_once;
  study_run::for_each_with_engine(parts, [&](std::size_t part, batch::BatchEngine& engine) {
    const std::size_t first = part * trials_at_once;
    const std::size_t count = std::min(trials_at_once, draws.size() - first);
    run_part(question, draws.subspan(first, count), std::span(results).subspan(first, count), engine, stop);
  });
  return results;
}

Simulation simulation_of(const Question& question, const std::stop_token& stop) {
  return [&question, stop](std::span<const TrialPoint> points) {
    std::vector<study::GivenDraws> draws;
    for (const TrialPoint& point : points) draws.push_back(draws_at(question, point));
    return run_trials(question, draws, stop);
  };
}

}  // namespace zerocount::rare

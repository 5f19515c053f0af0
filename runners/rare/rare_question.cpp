#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "experiments/study/setting_study.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::rare {

Question question_of(study::Study study, const Population& of, measures::MoveEvent event) {
  study::Study alone = in_setting(study, of.setting.value_or(0));
  Question question{std::move(study), std::move(alone), of, std::move(event), {}, {}};
  question.coordinates = randomness::random_coordinates(question.study, of.point);
  question.space = trial_space(question.coordinates.size(),
                               randomness::discrete_draws(question.study, of.point, question.coordinates));
  return question;
}

study::GivenDraws draws_at(const Question& question, const Trial& trial) {
  study::GivenDraws draws = randomness::draws_at(question.study, question.coordinates, trial.z, trial.number);
  draws.world = question.of.world;
  return draws;
}

study::StudyTrial trial_at(const Question& question, const Trial& trial) {
  return study::study_trial(question.study, question.of.point, 0, draws_at(question, trial));
}

void set_result(Trial& trial, const Question& question, std::span<const trial::MoveOutcome> moves) {
  trial.scores.assign(measures::move_scores.size(), statistics::unknown);
  std::int64_t failed = 0;
  std::int64_t asked = 0;
  for (const trial::MoveOutcome& move : moves) {
    if (!measures::is_asked(question.event, move)) continue;
    ++asked;
    failed += measures::happens(question.event, move) ? 1 : 0;
    for (std::size_t i = 0; i < trial.scores.size(); ++i)
      trial.scores[i] =
          std::fmax(trial.scores[i], measures::score_of(measures::move_scores[i], question.event, move));
  }
  trial.failed = static_cast<double>(failed) / static_cast<double>(asked);
}

void run_trials(const Question& question, std::span<Trial> trials, const trials::Effort& effort,
                std::vector<study::GivenDraws> draws) {
  const auto count = std::ssize(trials);
  if (draws.empty()) {
    draws.resize(trials.size());
    parallel::for_each_index(
        trials.size(), [&](std::size_t i) { draws[i] = draws_at(question, trials[i]); }, "draw");
  }
  const std::int64_t block = trials::block_for_lanes(count);
  const auto draw = [&](std::int64_t i) {
    const study::GivenDraws& given = draws[static_cast<std::size_t>(i)];
    return study::study_trial(question.study, question.of.point, 0, given).parameters;
  };
  trials::run(trials::numbered_trials(count, block, draw), effort,
              [&](std::size_t number, std::span<const trial::TrialOutcome> outcomes) {
                std::size_t next = number * static_cast<std::size_t>(block);
                for (const trial::TrialOutcome& outcome : outcomes)
                  set_result(trials[next++], question, outcome.moves);
              });
}

}  // namespace zerocount::rare

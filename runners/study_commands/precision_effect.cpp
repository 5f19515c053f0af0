#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/controller_code/program.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/trials/effort.hpp"
#include "runners/trials/study_runner.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::study_commands {
namespace {

using controller_code::Precision;

constexpr double max_samples = 2.0e7;  // of each precision: about ten seconds on one core
constexpr double least_trials = 20.0;
constexpr double most_trials = 500.0;
constexpr std::int64_t trials_of_block = 4;

/// Result of a trial: whether it meets the goal, and when its moves have settled.
struct End {
  bool meets{false};
  double settled{0.0};  ///< Time at which the slowest move of the trial has settled, s; infinity: never.
};

std::vector<End> ends_of(const study::Study& study, std::int64_t point, std::int64_t count,
                         const controller_code::ControllerToWrite& chain, Precision precision,
                         const std::stop_token& stop) {
  const auto law = controller_code::law_of(controller_code::chain_program(chain, precision));
  const goal::Question question = goal::question_of(study);
  const auto draw = [&](std::int64_t number) {
    trial::TrialParameters p = study::study_trial(study, point, number * study.trials / count).parameters;
    loop::ControllerParameters written;
    written.sample_rate = p.controller.sample_rate;
    written.delay = p.controller.delay;
    written.encoder = p.controller.encoder;
    written.missed = p.controller.missed;
    written.jitter = p.controller.jitter;
    written.user.plugin = law;
    p.controller = std::move(written);
    return p;
  };
  trials::TrialSet set = trials::numbered_trials(count, trials_of_block, draw);
  set.engine = study::Engine::reference;
  std::vector<End> ends(static_cast<std::size_t>(count));
  trials::run(
      set, trials::Effort(stop), [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
        std::size_t next = block * static_cast<std::size_t>(trials_of_block);
        for (const trial::TrialOutcome& outcome : outcomes)
          ends[next++] = {goal::meets(question, outcome.moves), goal::settling_time(question, outcome.moves)};
      });
  return ends;
}

/// Text of a quantile, over the trials, of the time at which the slowest move of a trial has settled: "0.05
/// s" or "never".
/// @param p probability of the quantile, 0 to 1
std::string settled_text(const std::vector<End>& ends, double p) {
  std::vector<double> settled;
  settled.reserve(ends.size());
  for (const End& end : ends) settled.push_back(end.settled);
  std::ranges::sort(settled);
  const double time =
      settled[static_cast<std::size_t>(statistics::quantile_rank(std::ssize(settled), p) - 1)];
  return std::isfinite(time) ? fmt::format("{:.6g} s", time) : "never";
}

}  // namespace

std::vector<std::string> effect_of_single_precision(const study::Study& study, std::int64_t point,
                                                    const controller_code::ControllerToWrite& chain,
                                                    const std::stop_token& stop) {
  const double affordable = max_samples / trials::samples_per_trial(study);
  const std::int64_t count =
      std::min(study.trials, static_cast<std::int64_t>(std::clamp(affordable, least_trials, most_trials)));
  const std::vector<End> in_double = ends_of(study, point, count, chain, Precision::double_precision, stop);
  const std::vector<End> in_single = ends_of(study, point, count, chain, Precision::single_precision, stop);
  std::int64_t otherwise = 0;
  for (std::size_t i = 0; i < in_single.size(); ++i)
    otherwise += in_single[i].meets != in_double[i].meets ? 1 : 0;
  return {fmt::format("What single precision changes in {} simulated trials (in double precision):", count),
          fmt::format("  {} trials {} ({}); {} are judged otherwise",
                      std::ranges::count_if(in_single, &End::meets),
                      goal::meeting_predicate(goal::question_of(study)),
                      std::ranges::count_if(in_double, &End::meets), otherwise),
          fmt::format("  settled: median {} ({}), 95 % {} ({})", settled_text(in_single, 0.5),
                      settled_text(in_double, 0.5), settled_text(in_single, 0.95),
                      settled_text(in_double, 0.95))};
}

}  // namespace zerocount::study_commands

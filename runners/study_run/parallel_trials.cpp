#include "runners/study_run/parallel_trials.hpp"

#include <memory>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "analysis/parallel/parallel.hpp"

namespace zerocount::study_run {

void for_each_with_engine(std::size_t count,
                          const std::function<void(std::size_t, batch::BatchEngine&)>& work) {
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<batch::BatchEngine>> engines(
      [] { return std::make_unique<batch::BatchEngine>(); });
  parallel::for_each_index(count, [&](std::size_t i) { work(i, *engines.local()); });
}

std::vector<trial::TrialOutcome> outcomes_of(std::span<const trial::TrialParameters> trials,
                                             batch::BatchEngine& engine, const std::stop_token& stop) {
  std::vector<const trial::TrialParameters*> parameters;
  parameters.reserve(trials.size());
  for (const trial::TrialParameters& one : trials) parameters.push_back(&one);
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  batch::BatchObservers observers;
  observers.stop = stop;
  engine.run(parameters, outcomes, observers);
  return outcomes;
}

}  // namespace zerocount::study_run

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::testing {

/// A manifest of experiments/manifests, with settings as after --set.
study::Study shipped_study(const std::string& name, const std::vector<std::string>& settings = {});

/// The design point with this label.
std::int64_t point_named(const study::Study& study, const std::string& label);

/// The parameters of trial `index` at the point with this label.
trial::TrialParameters trial_of(const study::Study& study, const std::string& label, std::int64_t index);

/// Outcomes of trials 0 … trials − 1 at that point, by the batch engine, as `run` has them.
std::vector<trial::TrialOutcome> outcomes_of(const study::Study& study, const std::string& label,
                                             std::int64_t trials);

/// A trial with all that can be seen of it.
struct WatchedTrial {
  trial::TrialParameters parameters;
  trial::TrialOutcome outcome;
  std::vector<trial::SampleRecord> samples;
  std::vector<trial::Jerk> jerks;
};

WatchedTrial watched(const trial::TrialParameters& parameters);

/// How many of the trials' moves have `what`.
template <class Predicate>
std::int64_t moves_with(const std::vector<trial::TrialOutcome>& trials, const Predicate& what) {
  std::int64_t count = 0;
  for (const trial::TrialOutcome& trial : trials) {
    for (const trial::MoveOutcome& move : trial.moves) count += what(move);
  }
  return count;
}

}  // namespace zerocount::testing

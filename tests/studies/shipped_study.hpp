#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::testing {

/// A manifest of experiments/manifests, with settings as after --set.
Study shipped_study(const std::string& name, const std::vector<std::string>& settings = {});

/// The design point with this label.
std::int64_t point_named(const Study& study, const std::string& label);

/// The parameters of trial `index` at the point with this label.
TrialParameters trial_of(const Study& study, const std::string& label, std::int64_t index);

/// Outcomes of trials 0 … trials − 1 at that point.
std::vector<TrialOutcome> outcomes_of(const Study& study, const std::string& label, std::int64_t trials);

/// A trial with all that can be seen of it.
struct WatchedTrial {
  TrialParameters parameters;
  TrialOutcome outcome;
  std::vector<SampleRecord> samples;
  std::vector<Jerk> jerks;
};

WatchedTrial watched(const TrialParameters& parameters);

/// How many of the trials' moves have `what`.
template <class Predicate>
std::int64_t moves_with(const std::vector<TrialOutcome>& trials, const Predicate& what) {
  std::int64_t count = 0;
  for (const TrialOutcome& trial : trials) {
    for (const MoveOutcome& move : trial.moves) count += what(move);
  }
  return count;
}

}  // namespace zerocount::testing

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::testing {

/// The study of a manifest in experiments/manifests, with settings in the form of --set.
study::Study shipped_study(const std::string& name, const std::vector<std::string>& settings = {});

/// Index of the design point with this label.
std::int64_t point_named(const study::Study& study, const std::string& label);

/// The parameters of trial `index` at the point with this label.
trial::TrialParameters trial_of(const study::Study& study, const std::string& label, std::int64_t index);

/// Outcomes of trials 0 … trials − 1 at the point with this label, computed by the batch engine as in `run`.
std::vector<trial::TrialOutcome> outcomes_of(const study::Study& study, const std::string& label,
                                             std::int64_t trials);

/// A simulated trial with everything that can be observed during it.
struct WatchedTrial {
  trial::TrialParameters parameters;
  trial::TrialOutcome outcome;
  std::vector<trial::SampleRecord> samples;
  std::vector<trial::Jerk> jerks;
};

WatchedTrial watched(const trial::TrialParameters& parameters);

/// Number of moves of these trials for which the predicate `what` is true.
template <class Predicate>
std::int64_t moves_with(const std::vector<trial::TrialOutcome>& trials, const Predicate& what) {
  std::int64_t count = 0;
  for (const trial::TrialOutcome& trial : trials) {
    for (const trial::MoveOutcome& move : trial.moves) count += what(move);
  }
  return count;
}

}  // namespace zerocount::testing

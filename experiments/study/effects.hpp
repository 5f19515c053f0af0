#pragma once

#include <span>
#include <string_view>

#include "core/random/trial_randomness.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::study {

/// An effect of a real axis: the parameter that is 0 where it is absent.
struct Effect {
  std::string_view parameter;             ///< dotted path; "#": of any element of a list
  std::string_view assumption{};          ///< that it and others are absent; empty: there is no such premise
  bool StudyFeatures::*feature{nullptr};  ///< of a study in which it acts
  random::RandomKey random::TrialRandomness::*draws{nullptr};  ///< that it takes while a trial runs
};

/// Those of one assumption follow one another.
std::span<const Effect> effects();

/// Whether the parameter of an effect differs from 0 in some trial of some point.
bool acts_somewhere(const StudyPlan& plan, std::string_view parameter);

}  // namespace zerocount::study

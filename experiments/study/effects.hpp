#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::study {

/// An effect of a real axis. From the table of effects follow the features of a study, its premises, the
/// random keys of its trials and whether they are a factor, and the rules of keys that act only with another
/// (experiments/rules/effect_rules.cpp). What lanes need (core/batch/lanes/lane_needs.cpp) is another
/// question: whether their kernels have what one trial uses, whatever the study is.
struct Effect {
  std::string_view parameter;     ///< 0 where it is absent; dotted path, "#": of any element of a list
  std::string_view assumption{};  ///< that it and others are absent; empty: there is no such premise
  bool StudyFeatures::*feature{nullptr};                       ///< of a study in which it acts
  random::RandomKey random::TrialRandomness::*draws{nullptr};  ///< that it takes while a trial runs
  std::string_view key{};  ///< name of the random key of these draws; a slash keeps it apart from parameters
  bool (*acts)(const StudyPlan& plan){nullptr};  ///< where more than the parameter decides
  std::string_view shape{};  ///< parameter that says how it acts, and has no effect without it
  bool along_track{false};   ///< it depends on the position on the rotor
};

std::span<const Effect> effects();

/// Whether a value can differ from 0.
bool can_be_nonzero(const ValueLimits& limits);

/// Whether the effect acts in some trial of some point.
bool acts(const StudyPlan& plan, const Effect& effect);

/// Lists the effects of a real axis that are absent by default. An effect is considered where
/// one of its parameters can differ from 0 in some trial of some point under some condition; otherwise it is
/// stated to be absent where the manifest gives one of them.
std::vector<Premise> premises_of(const StudyPlan& plan);

}  // namespace zerocount::study

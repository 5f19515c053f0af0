#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/random/random_numbers.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::study {

/// An effect of a real axis, such as encoder noise. The table of effects determines the features of a study,
/// its premises, the random keys of its trials, whether the numbers drawn within a trial are a factor, and
/// the rules for keys that act only together with another key (experiments/rules/effect_rules.cpp). It does
/// not decide whether the batch engine can run a trial in lanes: that depends on what the single trial uses
/// (core/batch/lanes/lane_needs.cpp).
struct Effect {
  /// Dotted path of the parameter that is 0 if the effect is absent; "#" stands for any element of a list.
  std::string_view parameter;
  /// Text of the assumption that the effect is absent, "no delay", as results list it. Effects with the same
  /// text share one assumption. Empty: the effect has none.
  std::string_view assumption{};
  /// Member of StudyFeatures that is set for studies in which the effect acts; null: none.
  bool StudyFeatures::*feature{nullptr};
  /// Key of the random numbers that the effect draws while a trial runs; null: it draws none.
  random::RandomKey random::TrialRandomness::*draws{nullptr};
  /// Name of the effect from which its random key is made. Its slash keeps it apart from the names of
  /// parameters.
  std::string_view key{};
  /// Test whether the effect acts, if that depends on more than `parameter`; null: it acts if `parameter` can
  /// differ from 0.
  bool (*acts)(const StudyPlan& plan){nullptr};
  /// Dotted path of a further parameter that describes how the effect acts; it has no effect if the effect is
  /// absent.
  std::string_view shape{};
  bool along_track{false};  ///< the effect depends on the position along the rotor
};

std::span<const Effect> effects();

/// Whether a parameter with this range can differ from 0 in some trial.
bool can_be_nonzero(const ParameterRange& range);

/// Whether the effect of a real axis, such as encoder noise, acts in at least one trial of at least one
/// design point.
bool acts(const StudyPlan& plan, const Effect& effect);

/// Lists the assumptions that effects of a real axis are absent, and their state. An effect is `considered`
/// if one of its parameters can differ from 0 in some trial. Otherwise it is `stated_none` if the manifest
/// gives one of these parameters, and `assumed` absent if it gives none.
std::vector<Premise> premises_of(const StudyPlan& plan);

}  // namespace zerocount::study

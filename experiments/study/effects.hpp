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
  /// Premise that the effect is absent, "no delay". Effects with the same text share one premise. Empty: the
  /// effect has no premise.
  std::string_view assumption{};
  bool StudyFeatures::*feature{nullptr};  ///< feature of the studies in which the effect acts; null: none
  /// Key of the random numbers that the effect draws while a trial runs; null: it draws none.
  random::RandomKey random::TrialRandomness::*draws{nullptr};
  /// Name from which the key `draws` is made. Its slash keeps it apart from the names of parameters.
  std::string_view key{};
  /// Test for an effect that depends on more than `parameter`; null: it acts if `parameter` can differ from
  /// 0.
  bool (*acts)(const StudyPlan& plan){nullptr};
  std::string_view shape{};  ///< parameter that describes how the effect acts; unused if the effect is absent
  bool along_track{false};   ///< the effect depends on the position on the rotor
};

std::span<const Effect> effects();

/// Whether a value with this range can differ from 0.
bool can_be_nonzero(const ParameterRange& range);

/// Whether the effect acts in at least one trial of at least one design point.
bool acts(const StudyPlan& plan, const Effect& effect);

/// Lists the premises about effects of a real axis that are absent by default. An effect is `considered` if
/// one of its parameters can differ from 0 in some trial of some point in some setting. Otherwise it is
/// `stated_none` if the manifest gives one of these parameters, and `assumed` absent if it gives none.
std::vector<Premise> premises_of(const StudyPlan& plan);

}  // namespace zerocount::study

#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {

/// Keys that have an effect only under a condition. A given key is reported if the condition holds at no
/// design point.
struct EffectRule {
  std::vector<std::string_view> keys{};        ///< dotted paths of parameters, or of sections for all in them
  std::vector<std::string_view> except{};      ///< those of them to which the rule does not apply
  std::vector<std::string_view> depends_on{};  ///< parameters that decide whether the keys have an effect
  std::function<bool(std::span<const study::ValueLimits>)>
      has_effect{};         ///< the condition, from the limits of those parameters in their order
  std::string what{};       ///< first phrase of the message
  std::string expected{};   ///< second phrase of the message; empty for a warning
  bool off_at_zero{false};  ///< a key that is 0 at all points is not reported
  bool warn_only{false};
};

/// The rules for a plan of this kind. If several rules match a key, the first violated one is reported.
std::vector<EffectRule> effect_rules(const study::StudyPlan& plan);

/// Whether the rule applies to the parameter with this dotted path.
bool covers(const EffectRule& rule, std::string_view name);

/// Whether the keys of the rule have an effect at some design point. True if a value could not be read.
bool can_have_effect(const study::StudyPlan& plan, const EffectRule& rule);

/// Whether the parameter with this dotted path has an effect at some design point, by all of these rules.
bool has_effect(const study::StudyPlan& plan, std::span<const EffectRule> rules, std::string_view name);

}  // namespace zerocount::rules

#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "experiments/study/point_limits.hpp"

namespace zerocount {

/// Keys that have an effect only where something else is so. One that is given although that is so at no
/// design point would be ignored, and is told.
struct EffectRule {
  std::vector<std::string_view> keys{};        ///< dotted paths of parameters, or of sections for all in them
  std::vector<std::string_view> depends_on{};  ///< parameters that decide whether the keys have an effect
  std::function<bool(std::span<const ValueLimits>)>
      has_effect{};             ///< from the limits of those parameters, in their order
  std::string_view what{};      ///< is wrong, for the message
  std::string_view expected{};  ///< instead; nothing where it is a warning
  bool off_at_zero{false};      ///< a key that is 0 at all points asks for nothing, and is let be
  bool warn_only{false};
};

/// The rules for a plan of this kind. Where several match a key, the first that is broken is told.
std::vector<EffectRule> effect_rules(const StudyPlan& plan);

/// Whether the keys of the rule have an effect at some design point. Where something could not be read, the
/// benefit of the doubt.
bool can_have_effect(const StudyPlan& plan, const EffectRule& rule);

}  // namespace zerocount

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/question.hpp"
#include "runners/tuning/effects/limits.hpp"

namespace zerocount::design_commands {

/// The answer of `limits` on a point of a study with targets.
/// @param tell gets what is being simulated
/// @throws trial::Interrupted, trials::Spent
document::Answer limits_of(const study::Study& study, std::int64_t point, const trials::Effort& effort,
                           const tuning::TellStage& tell = {});

/// Trials that limits_of() runs, about, where something is missed.
std::int64_t trials_of_limits(const study::Study& study, std::int64_t point);

/// "moves meet the goal 'small' under condition loaded in the worst world": what the rate of a claim
/// (tuning::Aim::claims) is the proportion of.
std::string rated_words(const study::Study& study, std::size_t claim);

/// The rates without each cause of failures as the item "limits", below `title`; the causes that are shown,
/// what was tried, and the reasons of those that are not simulated.
document::Description<std::vector<tuning::Limit>> limits_description(const std::string& title);

}  // namespace zerocount::design_commands

#pragma once

#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/question.hpp"
#include "runners/tuning/limits.hpp"

namespace zerocount::design_commands {

/// "moves meet the goal 'small' under condition loaded in the worst world": what the rate of a claim
/// (tuning::Aim::claims) is the proportion of.
std::string rated_words(const study::Study& study, std::size_t claim);

/// The rates without each cause of failures as the item "limits", below `title`; the reasons of those that
/// are not simulated.
document::Description<std::vector<tuning::Limit>> limits_description(const std::string& title);

}  // namespace zerocount::design_commands

#pragma once

#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/goal/question.hpp"
#include "runners/tuning/limits.hpp"

namespace zerocount::design_commands {

/// "moves meet the goal in the worst world": what the rates are the proportions of.
std::string rated_words(const goal::Question& question);

/// The rates without each cause of failures as the item "limits", below `title`; the reasons of those that
/// are not simulated.
document::Description<std::vector<tuning::Limit>> limits_description(const std::string& title);

}  // namespace zerocount::design_commands

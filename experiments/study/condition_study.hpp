#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The study under one of its conditions, as a study of its own: its manifest has the overrides of the
/// condition in the sections, and its trial j is trial TrialTurns::trial_of(j, condition) of the study.
/// Its columns of trials and its features are those of all conditions. Without conditions it is the study
/// itself.
/// @param condition number of one of Study::conditions
Study under_condition(const Study& study, std::int64_t condition);

/// Whether a column of trials (InputColumns::inputs) is one of the manifest that under_condition() describes:
/// a column that is there because the condition, or another one, overrides a number is not.
/// @param one of under_condition()
bool differs_under_condition(const Study& one, std::size_t column);

/// "@loaded": the end of the name of what differs between conditions, or points, in files.
std::string under_suffix(std::string_view place);

/// "kp=400, loaded": a design point under a condition, in answers; the label alone without a condition.
std::string label_under(std::string_view label, std::string_view condition);

/// The number of the condition of this name at this age, each of which may be left out where the study has
/// only one.
/// @throws Failure (bad_input) with those that there are
std::int64_t turn_named(const Study& study, const std::optional<std::string>& condition,
                        const std::optional<double>& age);

/// The number of the condition of this name.
/// @throws Failure (bad_input) with the names that there are
std::int64_t condition_named(const Study& study, std::string_view name);

}  // namespace zerocount::study

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/study/study.hpp"

namespace zerocount::study {

/// A study of a single condition: as if the sections of the manifest had the overrides of this condition.
/// Trial j of the result is trial TrialIndices::trial_of(j, condition) of the given study. The result keeps
/// the columns of trials and the features of the given study, which cover all conditions. Without conditions,
/// it is a copy of the study.
/// @param condition index in Study::conditions
Study under_condition(const Study& study, std::int64_t condition);

/// Whether a column of trials (InputColumns::inputs) differs between the trials or points under the one
/// condition. It does not if the column exists only because some condition overrides a number.
/// @param one result of under_condition()
/// @param column index in InputColumns::inputs
bool differs_under_condition(const Study& one, std::size_t column);

/// Suffix "@loaded" of a name in files, for items that differ between conditions or between points.
std::string under_suffix(std::string_view place);

/// Label of a design point under a condition in answers, "kp=400, loaded"; the label of the point alone if
/// `condition` is empty.
std::string label_under(std::string_view label, std::string_view condition);

/// The index in Study::conditions of a condition at an age. The condition may be left out if the study has at
/// most one, and so may the age.
/// @param condition one of Study::condition_names
/// @throws Failure (bad_input) with the existing names or ages, if the study does not have the given one
std::int64_t setting_named(const Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age);

/// The index in Study::conditions of the condition with this label.
/// @throws Failure (bad_input) with the existing labels, if there is no such condition
std::int64_t condition_named(const Study& study, std::string_view name);

}  // namespace zerocount::study

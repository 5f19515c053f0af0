#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/study/study.hpp"

namespace zerocount::study {

/// A study of one setting (a condition at an age) of the given study: as if the manifest had only the values
/// of this condition and age. Trial j of the result is trial TrialIndices::trial_of(j, setting) of the given
/// study. The result keeps the columns of trials and the features of the given study, which cover all
/// settings. Without conditions and ages, it is a copy of the study.
/// @param setting index of the setting
Study in_setting(const Study& study, std::int64_t setting);

/// Whether a column of trial inputs (InputColumns::inputs) differs between the trials or design points of a
/// study of one setting (a condition at an age). It does not if the column exists only because a condition
/// overrides a number, or because the value changes with age.
/// @param one result of in_setting()
/// @param column index in InputColumns::inputs
bool differs_in_setting(const Study& one, std::size_t column);

/// Suffix "@loaded" of a name in files, for items that differ between settings (conditions at an age) or
/// between design points.
std::string under_suffix(std::string_view place);

/// Label of a design point in a setting (a condition at an age), as answers show it: "kp=400, loaded". The
/// label of the point alone if the label of the setting is empty.
std::string label_under(std::string_view label, std::string_view setting);

/// The index of the setting that is a given condition at a given age. The condition may be left out if the
/// study has at most one, and so may the age.
/// @param condition one of Settings::conditions
/// @throws Failure (bad_input) with the existing names or ages, if the study does not have the given one
std::int64_t setting_named(const Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age);

/// The index of the setting (a condition at an age) with this label.
/// @throws Failure (bad_input) with the existing labels, if there is no such setting
std::int64_t setting_labelled(const Study& study, std::string_view label);

}  // namespace zerocount::study

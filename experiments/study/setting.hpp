#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/aging.hpp"

namespace zerocount::study {

/// The circumstances of a trial that the manifest lists instead of drawing them: a condition (such as
/// "loaded") at an age. Every machine is simulated in each setting with the same draws.
struct Setting {
  std::int64_t condition{0};  ///< Index in Settings::conditions; 0 without conditions.
  std::int64_t age{0};        ///< Index in Settings::ages; 0 without ages.

  bool operator==(const Setting&) const = default;
};

/// The numbers of conditions and ages of a study, and with them the index of each setting: with C conditions,
/// condition c at age a is setting c + C·a.
struct SettingCounts {
  std::int64_t conditions{1};  ///< number of conditions C; 1 without conditions
  std::int64_t ages{1};        ///< number of ages of the study; 1 without ages

  std::int64_t total() const { return conditions * ages; }
  Setting at(std::int64_t index) const { return {index % conditions, index / conditions}; }
  std::int64_t index_of(const Setting& setting) const { return setting.condition + conditions * setting.age; }
  bool operator==(const SettingCounts&) const = default;
};

/// The conditions and ages of a study. Its settings are all pairs of a condition and an age.
struct Settings {
  std::vector<std::string> conditions{};  ///< names of the conditions; empty: the study has no conditions
  Ages ages{};

  /// Whether the study has neither conditions nor ages.
  bool empty() const { return conditions.empty() && ages.at.empty(); }
  SettingCounts counts() const;
  /// Number of settings, each a condition at an age; 1 without conditions and ages.
  std::int64_t total() const { return counts().total(); }
  /// Number of settings that the manifest lists: total(), but 0 without conditions and ages.
  std::int64_t listed() const { return empty() ? 0 : total(); }
  Setting at(std::int64_t index) const { return counts().at(index); }
};

/// Whether sentences about a study mention its number of conditions: it has several, or it has one and no
/// ages.
bool counts_conditions(const Settings& settings);

/// The indices of the settings at this age, in order: one for each condition.
std::vector<std::int64_t> settings_at_age(const SettingCounts& counts, std::int64_t age);

/// Label of a setting, a condition at an age: "loaded", "100000 cycles" or "loaded, 100000 cycles"; empty
/// without conditions and ages.
std::string label_of(const Settings& settings, std::int64_t index);

/// [index of the setting] label_of() for each setting; empty without conditions and ages.
std::vector<std::string> labels_of(const Settings& settings);

/// Name of the condition in the setting with this index; empty without conditions.
std::string condition_of(const Settings& settings, std::int64_t index);

/// Phrase that names a setting in a sentence: " under condition loaded", or with ages " at loaded, 100000
/// cycles"; empty without conditions and ages.
std::string setting_phrase(const Settings& settings, std::int64_t index);
/// The phrase of setting_phrase() for the setting with this label.
std::string setting_phrase(const Settings& settings, std::string_view label);

/// The settings that the study would have at a single age: the same conditions, and no ages.
Settings without_ages(const Settings& settings);

}  // namespace zerocount::study

#include "experiments/study/setting.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include <fmt/ranges.h>

namespace zerocount::study {

SettingCounts Settings::counts() const {
  return {.conditions = std::max<std::int64_t>(std::ssize(conditions), 1),
          .ages = std::max<std::int64_t>(std::ssize(ages.at), 1)};
}

bool counts_conditions(const Settings& settings) {
  return settings.conditions.size() > (settings.ages.at.empty() ? 0U : 1U);
}

std::vector<std::int64_t> settings_at_age(const SettingCounts& counts, std::int64_t age) {
  std::vector<std::int64_t> settings;
  for (std::int64_t index = 0; index < counts.total(); ++index)
    if (counts.at(index).age == age) settings.push_back(index);
  return settings;
}

std::string label_of(const Settings& settings, std::int64_t index) {
  const Setting setting = settings.at(index);
  std::vector<std::string> parts;
  if (!settings.conditions.empty())
    parts.push_back(settings.conditions[static_cast<std::size_t>(setting.condition)]);
  if (!settings.ages.at.empty())
    parts.push_back(age_text(settings.ages, settings.ages.at[static_cast<std::size_t>(setting.age)]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<std::string> labels_of(const Settings& settings) {
  std::vector<std::string> labels;
  if (settings.empty()) return labels;
  for (std::int64_t index = 0; index < settings.total(); ++index) labels.push_back(label_of(settings, index));
  return labels;
}

std::string condition_of(const Settings& settings, std::int64_t index) {
  if (settings.conditions.empty()) return "";
  return settings.conditions[static_cast<std::size_t>(settings.at(index).condition)];
}

std::string setting_phrase(const Settings& settings, std::int64_t index) {
  return setting_phrase(settings, label_of(settings, index));
}

std::string setting_phrase(const Settings& settings, std::string_view label) {
  if (settings.empty()) return "";
  return fmt::format(" {} {}", settings.ages.at.empty() ? "under condition" : "at", label);
}

Settings without_ages(const Settings& settings) {
  return {.conditions = settings.conditions, .ages = {.at = {}, .unit = settings.ages.unit}};
}

}  // namespace zerocount::study

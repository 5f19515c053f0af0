#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/description.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/setting_study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::measures {

/// A design point in one setting (a condition at an age); if the study has no settings, just a design point.
struct PointInSetting {
  std::int64_t point{0};                 ///< Index of the design point.
  std::string label;                     ///< Label of the design point, with the setting if there is one.
  std::optional<std::string> setting{};  ///< Label of the setting; null if the study has no settings.
};

/// The items that identify a PointInSetting in JSON and CSV: index of the point, label and setting.
inline document::Description<PointInSetting> name_of_point() {
  return document::Description<PointInSetting>()
      .value(document::in_data("point", "number of the design point"), &PointInSetting::point)
      .value(document::in_data("label", "label of the design point, with the condition"),
             &PointInSetting::label)
      .value({.key = "condition",
              .meaning = "condition that the trials are under",
              .shown = document::Visibility::in_json,
              .optional = true},
             &PointInSetting::setting);
}

/// Calls `make(file, place)` for each design point in each setting, and returns the results ordered by point,
/// then by setting. `place` is a PointInSetting.
/// @param points indices of the points; empty: all points
/// @tparam Part type of the results; has the members of PointInSetting
/// @throws Failure (bad_input) for a point that does not exist
template <class Part, class Make>
std::vector<Part> at_points(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                            const Make& make) {
  const study::Study& study = file.study();
  if (points.empty()) {
    points.resize(static_cast<std::size_t>(study::point_count(study)));
    std::iota(points.begin(), points.end(), 0);
  }
  for (const std::int64_t point : points) {
    if (point >= 0 && point < study::point_count(study)) continue;
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: there is no design point {}; expected 0 to {}", file.path().string(),
                              point, study::point_count(study) - 1));
  }
  std::vector<std::vector<Part>> by_setting;
  reading::for_each_setting(file, [&](const reading::AllTrialsFile& one, const std::string& setting) {
    std::vector<Part>& parts = by_setting.emplace_back();
    parts.reserve(points.size());
    for (const std::int64_t point : points)
      parts.push_back(make(
          one, PointInSetting{
                   point, study::label_under(study.points.labels[static_cast<std::size_t>(point)], setting),
                   setting.empty() ? std::nullopt : std::optional(setting)}));
  });
  if (by_setting.size() == 1) return std::move(by_setting.front());
  std::vector<Part> ordered;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::vector<Part>& parts : by_setting) ordered.push_back(std::move(parts[i]));
  }
  return ordered;
}

}  // namespace zerocount::measures

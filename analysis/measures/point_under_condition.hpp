#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/document/description.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/condition_study.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::measures {

/// A design point under one condition; without conditions, just a design point.
struct PointUnderCondition {
  std::int64_t point{0};                   ///< number of the design point
  std::string label;                       ///< Label of the point, with the condition if there is one.
  std::optional<std::string> condition{};  ///< Condition of the trials; empty without conditions.
};

/// The items that name a PointUnderCondition in data: point, label and condition.
inline document::Description<PointUnderCondition> name_of_point() {
  return document::Description<PointUnderCondition>()
      .value(document::in_data("point", "number of the design point"), &PointUnderCondition::point)
      .value(document::in_data("label", "label of the design point, with the condition"),
             &PointUnderCondition::label)
      .value({.key = "condition",
              .meaning = "condition that the trials are under",
              .shown = document::Visibility::in_json,
              .optional = true},
             &PointUnderCondition::condition);
}

/// The results of `make(file, place)` for each point under each condition, ordered by point, then by
/// condition. `place` is a PointUnderCondition. @param points numbers of the points; empty: all points
/// @tparam Part type of the results; has the members of PointUnderCondition
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
  std::vector<std::vector<Part>> by_condition;
  reading::for_each_condition(file, [&](const reading::AllTrialsFile& one, const std::string& condition) {
    std::vector<Part>& parts = by_condition.emplace_back();
    parts.reserve(points.size());
    for (const std::int64_t point : points)
      parts.push_back(make(
          one, PointUnderCondition{
                   point, study::label_under(study.points.labels[static_cast<std::size_t>(point)], condition),
                   condition.empty() ? std::nullopt : std::optional(condition)}));
  });
  if (by_condition.size() == 1) return std::move(by_condition.front());
  std::vector<Part> ordered;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::vector<Part>& parts : by_condition) ordered.push_back(std::move(parts[i]));
  }
  return ordered;
}

}  // namespace zerocount::measures

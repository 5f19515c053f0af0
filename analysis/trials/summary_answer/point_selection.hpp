#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trials/summary/summary.hpp"
#include "results/layout/measure_table.hpp"

/// Selection and order of the design points that a table shows.
namespace zerocount::summary_answer {

/// The design points that a user asks for, and their order.
struct PointSelection {
  std::optional<std::string> sort{};  ///< Name of a value, with '-' in front for descending order; or "best".
  std::vector<std::string> where{};   ///< Conditions, such as "kp > 0" or "success_rate ≥ 0.9".
  std::optional<std::int64_t> top{};  ///< Number of points: the first by `sort`, or by points_by_merit().
};

/// The names of the statistics that a selection needs, without the names of swept parameters.
std::vector<std::string> columns_needed(const summary::StudySummary& summary,
                                        const PointSelection& selection);

/// Whether the selection names a bound of a mean by resampling ("arrival_time.mean_low").
bool needs_mean_bounds(const PointSelection& selection);

/// Checks that a selection is possible.
/// @throws Failure (bad_input) if the summary lacks a value that the selection needs
void require_columns(const summary::StudySummary& summary, const PointSelection& selection);

/// Indices of the design points that meet all conditions, in the order of the selection; `top` is ignored.
/// Values are named like the columns of the CSV, with '.' allowed for '_' ("arrival_time.p95"), or like swept
/// parameters, which may be shortened to a unique end ("ki"). A number may be rounded as answers show it
/// (text::values_as_written). NaN is sorted last and meets no condition. Texts, such as names of cases and
/// labels, can be compared by =, == and !=, and are sorted alphabetically.
/// @throws Failure (bad_input) for an unknown name or an invalid condition, (inconclusive) if no point is
/// left
/// @param known [name of a column][point] values that the file stores; they replace those of the statistics
std::vector<std::int64_t> matching_points(const summary::StudySummary& summary,
                                          const PointSelection& selection,
                                          const std::map<std::string, std::vector<double>>& known = {});

/// The first PointSelection::top points; all points if `top` is empty.
std::vector<std::int64_t> first_points(std::vector<std::int64_t> points, const PointSelection& selection);

/// A summary in which only some points have all statistics (StudySummary::complete).
struct SelectedSummary {
  summary::StudySummary summary;
  std::vector<std::int64_t> points{};  ///< Indices of the selected design points, in their order.
  /// Number of design points that meet the conditions. It may exceed the number selected, which `top` limits.
  std::int64_t matching{0};
  /// The measures of the points that do not have all; it is kept here because the summary refers to it.
  std::shared_ptr<const layout::MeasureTable> measures{};
};

/// The summary of a few design points of a complete results file. The points are selected, and the point of
/// the headline is chosen, by the statistics that the file stores. All other statistics are computed only for
/// these points, so a selection from 10⁵ points takes seconds, and a few bytes per point.
/// @param point index of the point of the headline; empty: the best
/// @returns empty if all points must be summarised: without a selection, with many selected points, if the
/// file does not store the values used for the selection, and for studies with worlds, `stop`, torque levels
/// or a sequence
/// @throws Failure in the cases of summarise() and matching_points()
std::optional<SelectedSummary> summarise_selected(const std::filesystem::path& path, bool bootstrap,
                                                  const PointSelection& selection,
                                                  std::optional<std::int64_t> point);

}  // namespace zerocount::summary_answer

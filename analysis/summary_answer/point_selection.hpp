#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/summary/summary.hpp"
#include "results/layout/measure_table.hpp"

/// Which design points a table shows, and in which order.
namespace zerocount::summary_answer {

/// The points that a user asks for.
struct PointSelection {
  std::optional<std::string> sort{};  ///< name of a value, with a leading '-' from the largest on; or "best"
  std::vector<std::string> where{};   ///< conditions, such as "kp > 0" or "success_rate ≥ 0.9"
  std::optional<std::int64_t> top{};  ///< so many of them, by points_by_merit() unless sorted otherwise
};

/// The values that a selection needs: the names of swept parameters left out.
std::vector<std::string> columns_needed(const summary::StudySummary& summary,
                                        const PointSelection& selection);

/// Whether it names a bound of a mean by resampling ("arrival_time.mean_low").
bool needs_mean_bounds(const PointSelection& selection);

/// @throws Failure (bad_input) where the summary has no value of a name that is needed
void require_columns(const summary::StudySummary& summary, const PointSelection& selection);

/// The points that meet all conditions, in their order; `top` is left out of account. Values have the names
/// of the columns of the CSV, where a '.' may stand for '_' ("arrival_time.p95"), and those of swept
/// parameters, which may be shortened to an end that no other has ("ki"). A number may be written as answers
/// show it, rounded (text::values_as_written). A value that is NaN comes last, and meets no condition. Names,
/// such as those of cases and labels, are equal (= or ==) or not (!=), and are sorted by the alphabet.
/// @throws Failure (bad_input) for an unknown name or a condition that is none, (inconclusive) if no point
/// is left
/// @param known [name of a column][point] values that the file stores, in place of those of the statistics
std::vector<std::int64_t> matching_points(const summary::StudySummary& summary,
                                          const PointSelection& selection,
                                          const std::map<std::string, std::vector<double>>& known = {});

/// The first of the points, as many as the selection asks for.
std::vector<std::int64_t> first_points(std::vector<std::int64_t> points, const PointSelection& selection);

/// The first_points() of the matching_points().
std::vector<std::int64_t> selected_points(const summary::StudySummary& summary,
                                          const PointSelection& selection);

/// A summary in which only some points have all statistics (StudySummary::complete).
struct SelectedSummary {
  summary::StudySummary summary;
  std::vector<std::int64_t> points{};  ///< Selected points, in their order.
  std::int64_t matching{0};            ///< Number of points that meet the conditions; `top` shows fewer.
  /// The measures of the points that have few; the summary refers to them.
  std::shared_ptr<const layout::MeasureTable> measures{};
};

/// The summary of few of the points of a complete results file: the points are selected, and the one that the
/// text speaks of is chosen, by the statistics that the file stores. All others are computed of the selected
/// ones and the chosen one alone, so that a few of 10⁵ points take seconds and bytes of each.
/// @param point the one that the text speaks of; nothing: the best
/// @returns nothing where all points are to be summarised: without a selection, or with many selected points,
/// where the file does not store what they are selected by, and for studies with worlds, `stop`, torque
/// levels or a sequence
/// @throws Failure as summarise() and selected_points()
std::optional<SelectedSummary> summarise_selected(const std::filesystem::path& path, bool bootstrap,
                                                  const PointSelection& selection,
                                                  std::optional<std::int64_t> point);

}  // namespace zerocount::summary_answer

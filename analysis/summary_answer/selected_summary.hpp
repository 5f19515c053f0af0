#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/summary/summary.hpp"
#include "analysis/summary_answer/point_selection.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::summary_answer {

/// A summary in which only some points have all statistics (StudySummary::complete).
struct SelectedSummary {
  summary::StudySummary summary;
  std::vector<std::int64_t> points{};  ///< that are selected, in their order
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

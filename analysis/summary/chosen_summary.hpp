#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/summary.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::summary {

/// The summary of a study of which only the chosen point is reported.
///
///     for each point: compute the statistics by which points are compared
///     choose a point
///     compute all statistics of this point
///
/// The memory is small for each of the other points, so a study may have 10⁵ of them.
struct ChosenSummary {
  StudySummary summary;  ///< Only the chosen point is complete (StudySummary::complete).
  ChosenPoint chosen;
  /// The measures of the points that are not complete; the summary refers to them.
  std::shared_ptr<const layout::MeasureTable> measures{};
};

/// The summary of a complete results file, which may keep trials or only statistics, and the chosen point.
/// @param point the point to report; empty: the best one
/// @throws Failure (bad_data) if the file is damaged
ChosenSummary summarise_chosen(const std::filesystem::path& path, std::optional<std::int64_t> point = {});

}  // namespace zerocount::summary

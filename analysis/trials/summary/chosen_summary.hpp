#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/summary.hpp"
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
  /// The few measures of the points that are not complete. It is kept here because the summary refers to it.
  std::shared_ptr<const layout::MeasureTable> measures{};
};

/// Summary of a complete results file, which may keep trials or only statistics, with all statistics of the
/// chosen design point.
/// @param point index of the point to report; empty: the best one
/// @throws Failure (bad_data) if the file is damaged
ChosenSummary summarise_chosen(const std::filesystem::path& path, std::optional<std::int64_t> point = {});

}  // namespace zerocount::summary

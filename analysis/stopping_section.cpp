#include "analysis/stopping_section.hpp"

#include <fmt/format.h>

#include "analysis/anytime_bounds.hpp"
#include "analysis/text.hpp"

namespace zerocount {
namespace {

std::vector<ConfidenceInterval> bounds_of(std::span<const PointSummary> points, double confidence) {
  std::vector<ConfidenceInterval> bounds;
  bounds.reserve(points.size());
  for (const PointSummary& point : points) {
    bounds.push_back(anytime_bounds(point.outcomes.zero_count, point.judged, confidence));
  }
  return bounds;
}

std::string text_of(const std::vector<ConfidenceInterval>& bounds, const std::vector<std::string>& labels,
                    const StoppingRule& rule) {
  const std::string head =
      fmt::format("{:.6g} % bounds of zero-count, however often one looks (%)", 100.0 * rule.confidence);
  std::vector<std::vector<std::string>> cells{{"point", head}};
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    cells.push_back({printable(labels[i]),
                     fmt::format("[{:.2f}, {:.2f}]", 100.0 * bounds[i].low, 100.0 * bounds[i].high)});
  }
  return aligned_table(cells, {false, false}) +
         fmt::format(
             "\nhow many trials there are was decided by their outcomes, after every {} at each "
             "point;\nall other bounds are those of a number fixed beforehand\n",
             rule.block);
}

}  // namespace

SummarySection stopping_section(std::span<const PointSummary> points, const std::vector<std::string>& labels,
                                const StoppingRule& rule) {
  const std::vector<ConfidenceInterval> bounds = bounds_of(points, rule.confidence);
  PointColumn low{"stopped_success_rate_low",
                  "1",
                  "lower bound of the success rate that holds however often one looks",
                  {}};
  PointColumn high{"stopped_success_rate_high",
                   "1",
                   "upper bound of the success rate that holds however often one looks",
                   {}};
  SummarySection section{.key = "stopped", .json = {}, .columns = {}, .text = text_of(bounds, labels, rule)};
  for (const ConfidenceInterval& interval : bounds) {
    low.values.push_back(interval.low);
    high.values.push_back(interval.high);
    section.json.push_back({{"success_rate_low", interval.low},
                            {"success_rate_high", interval.high},
                            {"confidence", rule.confidence}});
  }
  section.columns = {std::move(low), std::move(high)};
  return section;
}

}  // namespace zerocount

#include "analysis/summary/summary.hpp"

#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
void require_consistent(const StudySummary& summary) {
  const std::size_t points = summary.points.size();
  bool consistent = summary.labels.size() == points;
  consistent = consistent && (summary.predictions.empty() || summary.predictions.size() == points);
  for (const study::SweepAxis& axis : summary.axes) {
    const bool text = axis.kind == study::SweepAxis::Kind::text;
    consistent = consistent && (text ? axis.texts.size() : axis.numbers.size()) == points;
  }
  if (!consistent) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("study {}: labels, axes and statistics are not of the same {} points",
                              text::printable(summary.name), points));
  }
}

std::string observed_at(const StudySummary& summary, std::int64_t point) {
  const auto entry = summary.observed.find(summary.labels[static_cast<std::size_t>(point)]);
  return entry != summary.observed.end() ? entry->second : std::string{};
}

std::vector<std::int64_t> complete_points(const StudySummary& summary) {
  if (!summary.complete.empty()) return summary.complete;
  std::vector<std::int64_t> all(summary.points.size());
  std::iota(all.begin(), all.end(), std::int64_t{0});
  return all;
}

}  // namespace zerocount::summary

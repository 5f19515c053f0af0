#include "analysis/summary/summary.hpp"

#include <cstddef>

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
  for (const measures::SummarySection& section : summary.sections) {
    consistent = consistent && section.json.size() == points;
    for (const layout::PointColumn& column : section.columns)
      consistent = consistent && column.values.size() == points;
  }
  if (!consistent) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("study {}: labels, axes, statistics and sections are not of the same {} points",
                              text::printable(summary.name), points));
  }
}

std::string unfinished_sentence(const StudySummary& summary) {
  if (!summary.unfinished) return {};
  const std::int64_t without = summary.unfinished->points - std::ssize(summary.points);
  return fmt::format(
      "unfinished: of the {} of {} trials that the run has finished so far{}", summary.unfinished->finished,
      summary.unfinished->trials,
      without > 0 ? fmt::format("; {} of {} points have none yet", without, summary.unfinished->points) : "");
}

std::string observed_at(const StudySummary& summary, std::int64_t point) {
  const auto entry = summary.observed.find(summary.labels[static_cast<std::size_t>(point)]);
  return entry != summary.observed.end() ? entry->second : std::string{};
}

}  // namespace zerocount::summary

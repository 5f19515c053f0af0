#include "analysis/summary/summary.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

/// A line for every point with trials whose motion was lost: they count as failures, and the reader must
/// know.
std::string nonfinite_notes(const StudySummary& summary) {
  std::string notes;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const std::int64_t lost = summary.points[i].outcomes.nonfinite;
    if (lost == 0) continue;
    notes += fmt::format(
        "{}: {} of {} trials nonfinite: the motion left the finite numbers or could not be followed\n",
        text::printable(summary.labels[i]), lost, summary.points[i].trials);
  }
  return notes;
}

}  // namespace

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
  const std::int64_t begun = std::ranges::count_if(
      summary.points, [](const measures::PointSummary& point) { return point.trials > 0; });
  const std::int64_t without = summary.unfinished->points - begun;
  return fmt::format(
      "unfinished: of the {} of {} trials that the run has finished so far{}", summary.unfinished->finished,
      summary.unfinished->trials,
      without > 0 ? fmt::format("; {} of {} points have none yet", without, summary.unfinished->points) : "");
}

std::string observed_at(const StudySummary& summary, std::int64_t point) {
  const auto entry = summary.observed.find(summary.labels[static_cast<std::size_t>(point)]);
  return entry != summary.observed.end() ? entry->second : std::string{};
}

std::string bounds_head(const StudySummary& summary) {
  return text::percent(summary.confidence) + " bounds";
}

std::vector<std::string> observations(const StudySummary& summary) {
  std::vector<std::string> texts;
  bool any = false;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    texts.push_back(observed_at(summary, static_cast<std::int64_t>(i)));
    any = any || !texts.back().empty();
  }
  return any ? texts : std::vector<std::string>{};
}

std::string summary_table(const StudySummary& summary) {
  require_consistent(summary);
  const bool levels = summary.features.open_loop;
  const std::string unfinished = unfinished_sentence(summary);
  std::string text = text::printable(summary.name) + "\n" + (unfinished.empty() ? "" : unfinished + "\n") +
                     "\n" + text::aligned_table(levels ? level_columns(summary) : loop_columns(summary)) +
                     nonfinite_notes(summary) + "\n" +
                     (levels ? level_legend(summary.features.axis) : loop_legend(summary));
  for (const measures::SummarySection& section : summary.sections) {
    if (!section.text.empty()) text += "\n" + section.text;
  }
  return text;
}

}  // namespace zerocount::summary

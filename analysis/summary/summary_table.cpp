#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/summary_parts.hpp"

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

std::string bounds_head(const StudySummary& summary) {
  return fmt::format("{:.6g} % bounds", 100.0 * summary.confidence);
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
                     nonfinite_notes(summary) + "\n" + (levels ? level_legend() : loop_legend(summary));
  for (const measures::SummarySection& section : summary.sections) {
    if (!section.text.empty()) text += "\n" + section.text;
  }
  return text;
}

}  // namespace zerocount::summary

#include "analysis/summary/summary.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::summary {
namespace {

/// A line for every point with trials whose motion was lost: they count as failures, and the reader must
/// know.
std::string nonfinite_notes(const StudySummary& summary, std::span<const std::int64_t> points) {
  std::string notes;
  for (const std::int64_t point : points) {
    const auto i = static_cast<std::size_t>(point);
    const std::int64_t lost = summary.points[i].outcomes.nonfinite;
    if (lost == 0) continue;
    notes += fmt::format(
        "{}: {} of {} trials nonfinite: the motion left the finite numbers or could not be followed\n",
        text::printable(summary.labels[i]), lost, summary.points[i].trials);
  }
  return notes;
}

/// The sections about the question of the study, or the others.
std::string sections_text(const StudySummary& summary, std::span<const std::int64_t> points,
                          bool of_question) {
  std::string text;
  for (const measures::SummarySection& section : summary.sections) {
    const std::string section_text = measures::text_of(section, points);
    if (is_of_question(summary, section) == of_question && !section_text.empty()) text += "\n" + section_text;
  }
  return text;
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

bool is_of_question(const StudySummary& summary, const measures::SummarySection& section) {
  return !(section.of_success && summary.question.claim());
}

std::string bounds_head(const StudySummary& summary) {
  return text::percent(summary.confidence) + " bounds";
}

std::vector<std::string> observations(const StudySummary& summary) {
  std::vector<std::string> texts;
  bool any = false;
  for (const std::int64_t point : complete_points(summary)) {
    texts.push_back(observed_at(summary, point));
    any = any || !texts.back().empty();
  }
  return any ? texts : std::vector<std::string>{};
}

std::vector<std::int64_t> complete_points(const StudySummary& summary) {
  if (!summary.complete.empty()) return summary.complete;
  std::vector<std::int64_t> all(summary.points.size());
  std::iota(all.begin(), all.end(), std::int64_t{0});
  return all;
}

std::vector<std::int64_t> points_shown(const StudySummary& summary, const SummaryForm& form) {
  return form.points.empty() ? complete_points(summary) : form.points;
}

std::string summary_table(const StudySummary& summary, const SummaryForm& form) {
  require_consistent(summary);
  const bool levels = summary.features.open_loop;
  const std::vector<std::int64_t> points = points_shown(summary, form);
  const ChosenPoint chosen = choose_point(summary, form.chosen);
  const std::string unfinished = unfinished_sentence(summary);
  const text::PointTable table =
      levels ? level_table(summary)
             : text::PointTable{question_columns(summary, chosen.point), complete_points(summary)};
  std::string text = fmt::format("{}: {}\n{}{}\n\n{}{}", text::printable(summary.name), size_line(summary),
                                 unfinished.empty() ? "" : unfinished + "\n", design_line(summary),
                                 text::aligned_table(table, points), nonfinite_notes(summary, points));
  if (points.size() < summary.points.size())
    text += fmt::format("({} of {} points)\n", points.size(), summary.points.size());
  text += form.legend ? "" : "(zerocount summary --legend explains the columns)\n";
  if (form.legend) text += "\n" + (levels ? level_legend(summary.features.axis) : loop_legend(summary));
  text += sections_text(summary, points, true);
  if (summary.question.claim()) {
    text +=
        "\nzero counts\n\n" +
        text::aligned_table({zero_count_columns(summary, chosen.point), complete_points(summary)}, points);
  }
  text += sections_text(summary, points, false);
  return levels ? text : text + "\n" + verdict_text(summary, chosen);
}

}  // namespace zerocount::summary

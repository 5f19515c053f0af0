#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "core/text/text.hpp"

namespace zerocount::report {
namespace {

constexpr std::size_t max_rows = 400;

/// Indices of the design points that fit into the table: the first ones.
std::vector<std::int64_t> first_points(const ReportedStudy& reported) {
  const std::size_t rows_of_point =
      reported.study.open_loop ? std::max<std::size_t>(1, static_cast<std::size_t>(reported.file.moves()))
                               : 1;
  std::vector<std::int64_t> points(
      std::min(reported.summary.points.size(), std::max<std::size_t>(1, max_rows / rows_of_point)));
  std::iota(points.begin(), points.end(), std::int64_t{0});
  return points;
}

}  // namespace

std::string points_html(const ReportedStudy& reported) {
  const summary::StudySummary& summary = reported.summary;
  document::AnswerDescription<summary_answer::SummaryResults> answer;
  answer.items.sentence([&](const auto& s) { return summary_answer::design_line(s.summary); })
      .include(
          summary_answer::point_tables(summary), [](const auto& s) -> const auto& { return s; });
  const std::vector<std::int64_t> shown = first_points(reported);
  std::string html =
      document::html(answer.of(summary_answer::read_summary(summary, {shown, reported.chosen.point, true}),
                               ExitCode::success, document::Audience::people));
  if (shown.size() < summary.points.size()) {
    html += fmt::format(
        "<p class=\"note\">The first {} of {} points; all are printed by <code>zerocount "
        "summary</code>.</p>\n",
        shown.size(), summary.points.size());
  }
  return html;
}

}  // namespace zerocount::report

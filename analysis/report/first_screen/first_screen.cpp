#include "analysis/report/first_screen/first_screen.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/first_screen/assumptions.hpp"
#include "analysis/report/first_screen/axis_drawing.hpp"
#include "analysis/report/first_screen/gains.hpp"
#include "analysis/report/first_screen/requirements.hpp"
#include "analysis/report/report_sections.hpp"

namespace zerocount::report {
namespace {

/// A part with its head; empty without content.
std::string part_html(const char* head, const std::string& content) {
  return content.empty() ? "" : fmt::format("<div><h3>{}</h3>\n{}</div>\n", head, content);
}

std::string lines_html(const std::vector<std::string>& lines) {
  std::string html;
  for (const std::string& line : lines) html += fmt::format("<p>{}</p>\n", document::prose_markup(line));
  return html.empty() ? "" : "<div class=\"notes\">\n" + html + "</div>\n";
}

std::vector<summary::CellOfPoint> claims_of_chosen(const ReportedStudy& reported) {
  return summary::claims_of_point(reported.summary, reported.chosen.point,
                                  static_cast<std::size_t>(reported.chosen.chosen_from));
}

/// The class of the headline: "good" where all claims are met, "bad" where one is missed, else none.
std::string_view style_of(const std::vector<summary::CellOfPoint>& claims) {
  const auto has = [&](goal::Status status) {
    return std::ranges::find(claims, status, &summary::CellOfPoint::status) != claims.end();
  };
  if (has(goal::Status::missed)) return "bad";
  return has(goal::Status::met) && !has(goal::Status::undecided) ? "good" : "";
}

}  // namespace

PageSection first_screen(const ReportedStudy& reported, const FirstScreenParts& parts) {
  const Conclusions conclusions = conclusions_of(reported);
  const study::Study& study = reported.study;
  const std::int64_t point = reported.chosen.point;
  const std::vector<summary::CellOfPoint> claims =
      parts.claims.empty() ? claims_of_chosen(reported) : parts.claims;
  const std::string headline = parts.headline.empty() ? conclusions.headline : parts.headline;
  const std::string margins = parts.margins.empty() ? loops_html(study, point) : parts.margins;
  return {"overview",
          "",
          parts.warnings +
              fmt::format("<p class=\"headline {}\">{}</p>\n", style_of(claims),
                          document::prose_markup(headline)) +
              axis_svg(axis_diagram(study, point)) +
              part_html("Requirements", requirements_html(reported, claims)) + lines_html(conclusions.lines) +
              "<div class=\"columns\">\n" +
              part_html("Gains", study.open_loop ? "" : gains_html(study, point)) +
              part_html("Margins of the linear loops", margins) +
              part_html("Assumptions", assumptions_html(study, point)) + "</div>\n",
          {}};
}

std::string axis_html(const study::Study& study, std::int64_t point) {
  return axis_svg(axis_diagram(study, point)) + part_html("Assumptions", assumptions_html(study, point));
}

}  // namespace zerocount::report

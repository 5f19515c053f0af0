#include "analysis/report/answer_page.hpp"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "analysis/document/blocks.hpp"
#include "analysis/report/html.hpp"
#include "analysis/report/report_sections.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {

PageSection answer_section(std::string name, std::string title, const document::Answer& answer) {
  return {std::move(name), std::move(title), document::html(answer), document::figures(answer)};
}

PageSection figures_first(std::string name, std::string title, const document::Answer& answer) {
  PageSection section{std::move(name), std::move(title), "", document::figures(answer)};
  std::string rest;
  for (const document::Block& block : document::blocks(answer))
    (std::holds_alternative<document::HeadlineBlock>(block) ? section.html : rest) += document::html(block);
  section.html_after = html_folded("Numbers", rest);
  return section;
}

ReportPage answer_page(const document::Answer& answer) {
  return {answer.type.meaning,
          "",
          fmt::format("zerocount {}", layout::current_provenance().zerocount_version),
          {answer_section("answer", "Answer", answer)},
          answer.type.name};
}

}  // namespace zerocount::report

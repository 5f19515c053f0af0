#include "analysis/report/answer_page.hpp"

#include <utility>

#include <fmt/format.h>

#include "analysis/report/report_sections.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {

PageSection answer_section(std::string name, std::string title, const document::Answer& answer) {
  return {std::move(name), std::move(title), document::html(answer), document::figures(answer)};
}

ReportPage answer_page(const document::Answer& answer) {
  return {answer.type.meaning,
          "",
          fmt::format("zerocount {}", layout::current_provenance().zerocount_version),
          {answer_section("answer", "Answer", answer)},
          answer.type.name};
}

}  // namespace zerocount::report

#include "analysis/report/answer_page.hpp"

#include <fmt/format.h>

#include "results/layout/header.hpp"

namespace zerocount::report {

ReportPage answer_page(const document::Answer& answer) {
  const std::string title = fmt::format("zerocount {}", answer.type.name);
  return {title,
          answer.type.meaning,
          fmt::format("zerocount {}", layout::current_provenance().zerocount_version),
          {{"answer", "Answer", document::html(answer), document::figures(answer)}}};
}

}  // namespace zerocount::report

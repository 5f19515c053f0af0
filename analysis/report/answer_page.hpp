#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/report/page.hpp"

namespace zerocount::report {

/// An answer as a page of its own, with its figures.
ReportPage answer_page(const document::Answer& answer);

}  // namespace zerocount::report

#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "analysis/basis/text/report_json.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"

namespace zerocount::testing {

/// The answer of the command `summary` as text.
inline std::string summary_text(const summary::StudySummary& summary,
                                const summary_answer::SummaryForm& form = {}) {
  return document::text(summary_answer::summary_answer(summary, form));
}
inline nlohmann::ordered_json summary_json(const summary::StudySummary& summary,
                                           const summary_answer::SummaryForm& form = {}) {
  return document::json(summary_answer::summary_answer(summary, form));
}
inline std::string summary_csv(const summary::StudySummary& summary,
                               const summary_answer::SummaryForm& form = {}) {
  return document::csv(summary_answer::summary_answer(summary, form));
}

}  // namespace zerocount::testing

#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/document/figure.hpp"
#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {

/// The probability first, then what it rests on, and what failures have in common.
document::AnswerDescription<RareAnswer> rare_answer();

/// The ranges of the inputs in failures and in all trials.
std::vector<document::Figure> rare_figures(const std::vector<FailureInput>& inputs);

}  // namespace zerocount::rare

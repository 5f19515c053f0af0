#pragma once

#include <cstddef>
#include <limits>

#include "analysis/comparison/comparison.hpp"
#include "analysis/document/answer.hpp"
#include "analysis/history/series.hpp"
#include "analysis/sensitivity/sensitivity.hpp"

/// Answers with their figures, for pages.
namespace zerocount::report {

/// comparison::comparison_answer() with figures of all measures against their margins, and of the success
/// rate or the goal of each point.
document::AnswerDescription<comparison::StudyComparison> comparison_answer();

/// sensitivity::sensitivity_answer() with a figure of the Sobol' indices of each output.
document::AnswerDescription<sensitivity::StudySensitivity> sensitivity_answer();

/// history::history_answer() with a figure of each series, at most
/// `max_figures`, those that changed first.
document::AnswerDescription<history::History> history_answer(
    std::size_t max_figures = std::numeric_limits<std::size_t>::max());

}  // namespace zerocount::report

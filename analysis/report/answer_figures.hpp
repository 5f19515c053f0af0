#pragma once

#include <cstddef>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/sensitivity/sensitivity.hpp"

/// Answers with their figures, for pages.
namespace zerocount::report {

/// sensitivity::sensitivity_answer() with a figure of the Sobol' indices of each output.
document::AnswerDescription<sensitivity::StudySensitivity> sensitivity_answer();

}  // namespace zerocount::report

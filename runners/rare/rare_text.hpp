#pragma once

#include <string>

#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {

std::string json_of(const RareAnswer& answer, const Question& question);

/// The answer in sentences and tables: the probability first, then what it rests on.
std::string text_of(const RareAnswer& answer, const Question& question, const std::string& output);

/// One line while the estimate goes on.
std::string progress_text(const Estimate& estimate, const EstimatorState& state);

}  // namespace zerocount::rare

#pragma once

#include <filesystem>
#include <string>

#include "analysis/document/description.hpp"
#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {

/// An answer, the question, and the file that has its trials.
struct RareReading {
  const RareAnswer& answer;
  const Question& question;
  std::filesystem::path output;
};

/// The probability first, then what it rests on, and what failures have in common.
document::Description<RareReading> rare_description();

/// One line while the estimate goes on.
std::string progress_text(const Estimate& estimate, const EstimatorState& state);

}  // namespace zerocount::rare

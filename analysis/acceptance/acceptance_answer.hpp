#pragma once

#include <string>

#include "analysis/acceptance/acceptance.hpp"
#include "analysis/document/answer.hpp"

namespace zerocount::acceptance {

/// What the answer of `accept` is made of.
struct AcceptanceReading {
  const Acceptance& acceptance;
  std::string study;  ///< name of the file
  std::string point;  ///< label of the design point
};

document::AnswerDescription<AcceptanceReading> acceptance_answer();

/// success for accepted, regression for rejected, inconclusive.
ExitCode exit_code_of(Status status);

}  // namespace zerocount::acceptance

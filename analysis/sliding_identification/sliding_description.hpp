#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/sliding_identification/sliding_identification.hpp"

namespace zerocount::sliding_identification {

/// The parameters, what was used of the records, and the fragment of a manifest.
document::AnswerDescription<SlidingIdentification> sliding_answer();

}  // namespace zerocount::sliding_identification

#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/law_identification/law_identification.hpp"

namespace zerocount::law_identification {

/// The comparison, the parameters of every law, and the fragment of a manifest of the best one.
document::AnswerDescription<LawComparison> laws_answer();

}  // namespace zerocount::law_identification

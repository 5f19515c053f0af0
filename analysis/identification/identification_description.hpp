#pragma once

#include "analysis/document/answer.hpp"
#include "analysis/identification/identification.hpp"

namespace zerocount::identification {

/// The parameters, the parts of the records, the checks of the residuals and the fragment of a manifest.
document::AnswerDescription<Identification> identification_answer();

}  // namespace zerocount::identification

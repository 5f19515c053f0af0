#pragma once

#include <string>
#include <string_view>

#include "analysis/document/answer.hpp"
#include "analysis/monitor/parameter_change.hpp"

namespace zerocount::monitor {

std::string_view word_of(ChangeTold told);

/// A sentence that names the parameter that differs.
std::string explanation_text(const ChangeExplanation& explanation);

document::Description<ParameterChange> parameter_description();

}  // namespace zerocount::monitor

#pragma once

#include <string>
#include <string_view>

#include "experiments/yaml/problems.hpp"

namespace zerocount {

/// What yaml-cpp means by the message of its exception, in words for those who have not read the YAML
/// specification.
std::string syntax_fault(const std::string& message);

/// The first place in `text` that is not UTF-8, or is a control character; line 0 where there is none.
Place first_bad_byte(const std::string& text, std::string_view source);

}  // namespace zerocount

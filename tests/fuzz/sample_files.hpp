#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace zerocount::fuzz {

/// Contents of the files that inputs refer to, in order of their names: those in the folder files/`target`
/// beside the executable. Ends the process if there are none.
std::vector<std::string> sample_files(std::string_view target);

}  // namespace zerocount::fuzz

#pragma once

#include <string>

#include "analysis/identification/identification.hpp"

namespace zerocount::identification {

/// The parameters, the parts of the records, the checks and the manifest fragment as text.
std::string identification_text(const Identification& identification);

/// The same as one JSON object. Numbers read back to the same double; missing values are null.
std::string identification_json(const Identification& identification);

}  // namespace zerocount::identification

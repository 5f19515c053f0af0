#pragma once

#include <string>

#include "analysis/identification/identification.hpp"

namespace zerocount {

/// A table of the parameters, the records' parts, the checks and the fragment, to be read.
std::string identification_text(const Identification& identification);

/// The same as one JSON object. Its numbers read back to the same double; null where there is none.
std::string identification_json(const Identification& identification);

}  // namespace zerocount

#pragma once

#include <nlohmann/json_fwd.hpp>

#include "analysis/identification/identification.hpp"

namespace zerocount::identification {

/// An estimate as a JSON object: its name, key, unit and status, and its numbers in that unit. A parameter
/// without a key has the key null.
nlohmann::ordered_json estimate_json(const ParameterEstimate& estimate);

}  // namespace zerocount::identification

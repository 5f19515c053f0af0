#pragma once

#include <nlohmann/json.hpp>

namespace zerocount {

/// The JSON Schema (draft 2020-12) of manifests, for editors: from the table of parameters, so every key,
/// range, word and distribution is in it. It accepts every manifest that parse_study accepts; what needs more
/// than one key to judge (a support inside its range, dwell and hold, labels under `observed`) only
/// parse_study checks.
nlohmann::ordered_json json_schema();

}  // namespace zerocount

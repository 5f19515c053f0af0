#pragma once

#include <nlohmann/json_fwd.hpp>

namespace zerocount::manifest {

/// The JSON Schema (draft 2020-12) of manifests, for editors. Generated from the table of parameters, it has
/// every key, range, label and distribution. It accepts every manifest that parse_study accepts. Only
/// parse_study checks conditions that involve more than one key (a support inside its range, dwell and hold,
/// labels under `observed`).
nlohmann::ordered_json json_schema();

}  // namespace zerocount::manifest

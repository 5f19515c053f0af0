#pragma once

#include <optional>
#include <span>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/keys/values.hpp"

namespace zerocount::keys {

/// Reads the value of a regular key as its row says, and stores it in the study. Reports errors; the study
/// keeps its default then.
void read_key(const yaml::Field& field, const GeneralKey& key, Reading& reading);

/// Reports the keys that `map` lacks, and reads those that are there. Unknown keys are the caller's.
void read_keys(const yaml::Field& map, std::span<const GeneralKey> keys, Reading& reading);

/// The value of an optional key that a manifest leaves out: that of the structs of study. Empty where
/// no value means the same as a missing key, as for `rigs`.
std::optional<double> default_of(const GeneralKey& key);

}  // namespace zerocount::keys

#pragma once

#include "experiments/keys/values.hpp"

namespace zerocount::sections {

/// Reads `goal`, or `goals`, of the manifest. Adds their bands and tolerances to those of the plan. The
/// study's rigs and all parameters must be read already.
void read_goals(const yaml::Field& root, keys::Reading& reading);

/// Reads the stopping rule `stop`. The manifest's `trials` become the size of a block, and the study's number
/// of trials becomes the maximum.
void read_stop(const yaml::Field& field, keys::Reading& reading);

/// Reads `tune`. The study's goal and all parameters must be read already.
void read_tuning(const yaml::Field& field, keys::Reading& reading);

}  // namespace zerocount::sections

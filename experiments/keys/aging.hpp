#pragma once

#include <optional>
#include <string_view>

#include "experiments/keys/values.hpp"

namespace zerocount::keys {

inline constexpr std::string_view aging_key = "aging";
/// The form of a value that is one number, where `aging` stands beside it: {value: 3, aging: ...}.
inline constexpr std::string_view value_key = "value";

/// Reads `aging` beside the form of the value of a slot: {exponential: -0.1, scale: 1.0e+6}. The value gets
/// its law, and Reading::rate the value of the slot of its rate, which is added to the plan. Reports errors.
/// @param field of `aging`
void read_aging(const yaml::Field& field, std::size_t slot, study::Value& value, Reading& reading);

}  // namespace zerocount::keys

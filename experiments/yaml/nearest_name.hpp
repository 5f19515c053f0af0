#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zerocount {

/// The candidate with the smallest Levenshtein distance to `name`, the first of equals; empty where there is
/// none or the name is too long to be a slip of the keyboard.
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Whether `name` may be a slip of the pen for `candidate`: at most one edit for every three letters of the
/// longer of the two.
bool is_near(std::string_view name, std::string_view candidate);

}  // namespace zerocount

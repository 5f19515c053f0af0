#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zerocount::yaml {

/// The candidate with the smallest Levenshtein distance to `name`, the first of equals; empty if there is
/// none or the name is too long for a typing error.
std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Whether `name` may be a misspelling of `candidate`: at most one edit for every three letters of the
/// longer of the two.
bool is_near(std::string_view name, std::string_view candidate);

}  // namespace zerocount::yaml

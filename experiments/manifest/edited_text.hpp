#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace zerocount::manifest {

/// The text of a manifest with the override "path=value" (path: dotted keys) written into it: the value at
/// the path is replaced, or the missing keys are added. All else, comments included, stays as it is.
/// @param value in flow style
/// @returns nothing where the edited text would not mean the same as the override: the path leads through a
/// list, or into a value that an alias repeats.
std::optional<std::string> with_override(const std::string& text, std::string_view path,
                                         std::string_view value);

}  // namespace zerocount::manifest

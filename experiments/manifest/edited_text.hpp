#pragma once

#include <string>
#include <string_view>

namespace zerocount::manifest {

/// The text of a manifest with `path` (a dotted path of keys) set to `value`, a number or a word: the scalar
/// at the path is replaced, or the missing keys are added. All else, comments included, stays as it is.
/// @throws Failure (bad_input) if the text is no YAML, or the path leads to or through something else.
std::string with_scalar(const std::string& text, std::string_view path, std::string_view value);

}  // namespace zerocount::manifest

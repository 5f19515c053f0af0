#pragma once

#include <string>

namespace zerocount {

/// The table of parameters for a terminal: sections, and of every parameter its name, unit, default, range,
/// source and meaning; then the distributions and the other keys of a manifest.
std::string parameters_as_text();

/// The same as Markdown tables.
std::string parameters_as_markdown();

}  // namespace zerocount

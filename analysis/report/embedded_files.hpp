#pragma once

#include <array>
#include <span>
#include <string_view>

#include "core/text/embedded_file.hpp"

namespace zerocount::report {

using EmbeddedFile = text::EmbeddedFile;

/// All embedded files: the Vega-Lite specifications, the page of the report, and the JavaScript libraries for
/// drawing (if they were installed at build time).
std::span<const EmbeddedFile> embedded_files();

/// The contents of an embedded file.
/// @throws Failure (machine_failed) if the program was built without it; the message says how to include it.
std::string_view embedded_file(std::string_view name);

/// The libraries for drawing, in loading order.
inline constexpr std::array<std::string_view, 3> drawing_libraries{"vega.min.js", "vega-lite.min.js",
                                                                   "vega-embed.min.js"};

/// @throws Failure (machine_failed) if the program was built without one of them, so before work is lost.
void require_drawing_libraries();

}  // namespace zerocount::report

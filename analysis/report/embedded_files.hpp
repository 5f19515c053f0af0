#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zerocount {

/// A file that was put into the program when it was built.
struct EmbeddedFile {
  std::string_view name;  ///< "vega.min.js"
  std::string_view bytes;
};

/// All of them: the Vega-Lite specifications and the page of the report, and, where they were there when the
/// program was built, the JavaScript libraries that draw.
std::span<const EmbeddedFile> embedded_files();

/// The bytes of one of them.
/// @throws Failure (machine_failed) where the program was built without it; the message says how to build it
/// with it.
std::string_view embedded_file(std::string_view name);

/// The libraries that draw, in the order in which they are to be loaded.
std::span<const std::string_view> drawing_libraries();

}  // namespace zerocount

#pragma once

#include <string_view>

namespace zerocount::text {

/// A file that is embedded in the program when it is built (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
  std::string_view name;  ///< "vega.min.js"
  std::string_view bytes;
};

}  // namespace zerocount::text

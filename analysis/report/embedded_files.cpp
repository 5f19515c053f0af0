#include "analysis/report/embedded_files.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::report {

std::string_view embedded_file(std::string_view name) {
  const std::span<const EmbeddedFile> files = embedded_files();
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const EmbeddedFile& file) { return file.name == name; });
  if (found != files.end()) return found->bytes;
  throw Failure(
      ExitCode::machine_failed,
      fmt::format("this zerocount was built without {}, which draws the figures; in its sources, run "
                  "'npm ci --prefix analysis/report' (./quickstart does), then cmake and the build again",
                  name));
}

void require_drawing_libraries() {
  for (const std::string_view library : drawing_libraries) embedded_file(library);
}

}  // namespace zerocount::report

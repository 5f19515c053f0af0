#include "runners/output_place.hpp"

#include <system_error>

#include <fmt/format.h>

#include "core/failure.hpp"

namespace zerocount {

std::filesystem::path output_place(const Arguments& arguments) {
  std::filesystem::path output = arguments.required("output");
  if (!output.has_filename() || std::filesystem::is_directory(output)) {
    arguments.refuse(fmt::format("option '--output': '{}' is a folder; name a file in it", output.string()));
  }
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot be written: there is no folder {}; make it first", output.string(),
                              folder.string()));
  }
  return output;
}

}  // namespace zerocount

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

void protect_from_outputs(const Arguments& arguments, const std::vector<std::filesystem::path>& inputs,
                          const std::vector<std::filesystem::path>& outputs) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const fs::path& output = outputs[i];
    for (const fs::path& input : inputs) {
      if (fs::equivalent(input, output, error)) {
        arguments.refuse(
            fmt::format("{} is read, and must not be written over; name another output", output.string()));
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (fs::weakly_canonical(fs::absolute(output), error) ==
          fs::weakly_canonical(fs::absolute(outputs[j]), error)) {
        arguments.refuse(fmt::format("{} is named for two outputs; name two files", output.string()));
      }
    }
    if (fs::exists(output, error) && !fs::is_regular_file(output, error)) {
      arguments.refuse(fmt::format("{} is no regular file; name a file to write", output.string()));
    }
  }
}

}  // namespace zerocount

#include "runners/command_line/output_place.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::command_line {
namespace {

namespace fs = std::filesystem;

/// A link, a device or a pipe is never an output: a new file would be put in its place.
fs::path file_in_folder(const Arguments& arguments, std::string_view option) {
  fs::path output = arguments.required(option);
  std::error_code error;
  if (!output.has_filename() || fs::is_directory(output, error)) {
    arguments.refuse(
        fmt::format("option '--{}': '{}' is a folder; name a file in it", option, output.string()));
  }
  const fs::file_status there = fs::symlink_status(output, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    arguments.refuse(fmt::format("option '--{}': {} is not a regular file ({}); name a file to write", option,
                                 output.string(), fs::is_symlink(there) ? "a link" : "a device or a pipe"));
  }
  const fs::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (!fs::is_directory(folder, error)) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{}: cannot be written: the folder {} does not exist; create it first",
                              output.string(), folder.string()));
  }
  return output;
}

/// @throws Failure: bad_input if `output` exists and --force is not given; machine_failed if it is
/// write-protected.
void require_replaceable(const Arguments& arguments, const fs::path& output) {
  std::error_code error;
  if (arguments.has("force")) return storage::require_replaceable(output);
  if (!fs::exists(output, error)) return;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: exists already; give --force to replace it, or name another file", output.string()));
}

}  // namespace

OptionSpec force_option() {
  return {"force", "", "replace an output that exists already"};
}

fs::path output_place(const Arguments& arguments) {
  if (yaml::is_standard_stream(arguments.required("output"))) {
    arguments.refuse("option '--output': a results file cannot go to standard output; name a file");
  }
  return file_in_folder(arguments, "output");
}

std::optional<fs::path> text_place(const Arguments& arguments, std::string_view option) {
  if (!arguments.has(option)) return std::nullopt;
  fs::path place = arguments.required(option);
  if (yaml::is_standard_stream(place)) return place;
  return file_in_folder(arguments, option);
}

void require_no_input(const Arguments& arguments, const fs::path& output, std::span<const fs::path> inputs) {
  std::error_code error;
  for (const fs::path& input : inputs) {
    if (fs::equivalent(input, output, error)) {
      arguments.refuse(
          fmt::format("{} is an input and must not be overwritten; name another output", output.string()));
    }
  }
}

void require_apart(const Arguments& arguments, const fs::path& output, std::span<const fs::path> others) {
  std::error_code error;
  for (const fs::path& other : others) {
    if (fs::weakly_canonical(fs::absolute(output), error) ==
        fs::weakly_canonical(fs::absolute(other), error)) {
      arguments.refuse(fmt::format("{} is the name of two outputs; name two files", output.string()));
    }
  }
}

void require_places(const Arguments& arguments, const std::vector<fs::path>& inputs,
                    const std::vector<fs::path>& outputs) {
  if (std::count_if(inputs.begin(), inputs.end(), yaml::is_standard_stream) > 1) {
    arguments.refuse("standard input (-) can be read only once");
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    require_no_input(arguments, outputs[i], inputs);
    require_apart(arguments, outputs[i], std::span(outputs).first(i));
    if (!yaml::is_standard_stream(outputs[i])) require_replaceable(arguments, outputs[i]);
  }
}

void write_text(const fs::path& place, std::string_view text) {
  if (yaml::is_standard_stream(place)) {
    standard_output::write(text);
  } else {
    storage::replace_file(place, text);
  }
}

}  // namespace zerocount::command_line

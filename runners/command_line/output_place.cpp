#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::command_line {
namespace {

namespace fs = std::filesystem;

/// Path of the output file that the option names, with a check that its folder exists. A folder, a link, a
/// device or a pipe is refused, because a new file would be put in its place.
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

fs::path output_of_option(const Arguments& arguments, std::string_view option) {
  const FileUse use = arguments.file_use(option);
  if (use == FileUse::none || use == FileUse::read)
    throw std::logic_error("option not declared as an output");
  fs::path output = file_in_folder(arguments, option);
  if (use == FileUse::written || use == FileUse::kept) require_replaceable(arguments, output);
  return output;
}

/// Canonical path of a file (absolute, without links), which need not exist.
fs::path destination(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(whole, error);
  return error ? whole.lexically_normal() : canonical;
}

bool are_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) || destination(a) == destination(b);
}

/// A file that a command reads or writes, and the option that names it: "--report", or "" for an operand.
struct NamedFile {
  fs::path path;
  std::string option;
};

struct CommandFiles {
  std::vector<NamedFile> inputs;
  std::vector<NamedFile> outputs;
};

CommandFiles files_of(const Arguments& arguments) {
  CommandFiles files;
  const std::size_t words = arguments.spec().operand_words.empty() ? 0 : 1;
  for (std::size_t i = words; i < arguments.operands().size(); ++i)
    files.inputs.push_back({arguments.operands()[i], ""});
  for (const OptionSpec& option : arguments.spec().options) {
    if (option.file == FileUse::none) continue;
    const std::string name = long_name(option);
    std::vector<NamedFile>& list = option.file == FileUse::read ? files.inputs : files.outputs;
    for (const std::string& path : arguments.values(name)) list.push_back({path, "--" + name});
  }
  return files;
}

[[noreturn]] void refuse_output(const Arguments& arguments, const std::string& problem) {
  try {
    arguments.refuse(problem);
  } catch (const Failure& failure) {
    throw RefusedOutput(failure);
  }
}

[[noreturn]] void refuse_input(const Arguments& arguments, const fs::path& output) {
  refuse_output(arguments, fmt::format("{} is an input and must not be overwritten; name another output",
                                       output.string()));
}

[[noreturn]] void refuse_equal_outputs(const Arguments& arguments, const fs::path& output,
                                       const std::string& options = "") {
  refuse_output(arguments,
                fmt::format("{} is the name of two outputs{}; name two files", output.string(), options));
}

}  // namespace

void require_replaceable(const Arguments& arguments, const fs::path& output) {
  std::error_code error;
  if (arguments.has("force")) return storage::require_replaceable(output);
  if (!fs::exists(output, error)) return;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: exists already; give --force to replace it, or name another file", output.string()));
}

void require_separate_files(const Arguments& arguments) {
  const CommandFiles files = files_of(arguments);
  if (std::ranges::count_if(files.inputs, yaml::is_standard_stream, &NamedFile::path) > 1)
    arguments.refuse("standard input (-) can be read only once");
  for (std::size_t i = 0; i < files.outputs.size(); ++i) {
    const NamedFile& output = files.outputs[i];
    for (const NamedFile& other : std::span(files.outputs).first(i)) {
      if (are_same_file(output.path, other.path))
        refuse_equal_outputs(arguments, output.path,
                             fmt::format(" ({} and {})", other.option, output.option));
    }
    if (yaml::is_standard_stream(output.path)) continue;
    for (const NamedFile& input : files.inputs) {
      if (are_same_file(output.path, input.path)) refuse_input(arguments, output.path);
    }
  }
}

std::vector<fs::path> outputs_of(const Arguments& arguments) {
  std::vector<fs::path> outputs;
  for (NamedFile& output : files_of(arguments).outputs) outputs.push_back(std::move(output.path));
  return outputs;
}

EarlierAnswers::EarlierAnswers(const Arguments& arguments) {
  const std::string force = force_option().name;
  if (std::ranges::find(arguments.spec().options, force, &OptionSpec::name) == arguments.spec().options.end())
    return;
  if (!arguments.has(force)) return;
  for (const OptionSpec& option : arguments.spec().options) {
    if (option.file != FileUse::written && option.file != FileUse::page) continue;
    for (const std::string& path : arguments.values(long_name(option))) {
      std::error_code error;
      const bool is_file =
          !yaml::is_standard_stream(path) && fs::is_regular_file(fs::symlink_status(path, error));
      const fs::file_time_type written = is_file ? fs::last_write_time(path, error) : fs::file_time_type{};
      if (is_file && !error) answers_.push_back({path, written});
    }
  }
}

void EarlierAnswers::remove_remaining() const {
  for (const Answer& answer : answers_) {
    std::error_code error;
    if (fs::last_write_time(answer.path, error) != answer.written || error) continue;
    try {
      storage::require_replaceable(answer.path);
    } catch (const Failure&) {
      continue;
    }
    fs::remove(answer.path, error);
  }
}

OptionSpec force_option() {
  return {"force", "", "replace an output that exists already"};
}

fs::path output_place(const Arguments& arguments) {
  if (yaml::is_standard_stream(arguments.required("output"))) {
    arguments.refuse("option '--output': a results file cannot go to standard output; name a file");
  }
  return output_of_option(arguments, "output");
}

std::optional<fs::path> text_place(const Arguments& arguments, std::string_view option) {
  if (!arguments.has(option)) return std::nullopt;
  fs::path place = arguments.required(option);
  if (yaml::is_standard_stream(place)) return place;
  return output_of_option(arguments, option);
}

void require_no_output(const Arguments& arguments, const fs::path& input, std::span<const fs::path> outputs) {
  for (const fs::path& output : outputs) {
    if (!yaml::is_standard_stream(output) && are_same_file(input, output)) refuse_input(arguments, output);
  }
}

void require_apart(const Arguments& arguments, const fs::path& output, std::span<const fs::path> others) {
  for (const fs::path& other : others) {
    if (are_same_file(output, other)) refuse_equal_outputs(arguments, output);
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

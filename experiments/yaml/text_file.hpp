#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// Text files named by the user.
namespace zerocount::yaml {

/// Whether `path` is "-", which means standard input or output.
bool is_standard_stream(const std::filesystem::path& path);

/// Whether `path` is "-" or a pipe, such as <(command) of a shell: it can be read only once.
bool is_stream(const std::filesystem::path& path);

/// Name of a text in messages: the path, or "<stdin>".
std::string name_of_text(const std::filesystem::path& path);

/// The text of a file or pipe, or of standard input for "-". Reads at most `max_size` + 1 bytes, so that the
/// caller can detect a text that is too long.
/// @param expected completes "expected", such as "a manifest"
/// @throws Failure: bad_input if the file does not exist or is a directory or device; machine_failed if it
/// cannot be read.
std::string read_text(const std::filesystem::path& path, std::size_t max_size, std::string_view expected);

}  // namespace zerocount::yaml

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// Text files that a user names.
namespace zerocount {

/// Whether `path` is "-", which stands for standard input or output wherever text is read or written.
bool is_standard_stream(const std::filesystem::path& path);

/// How messages call a text: the path, or "<stdin>".
std::string name_of_text(const std::filesystem::path& path);

/// The text of a file, or of standard input for "-". Of a text longer than `max_size` bytes one byte more is
/// returned, so that a huge or endless one is noticed at once.
/// @param expected completes "expected", such as "a manifest"
/// @throws Failure: bad_input where there is no such file or it is a directory; machine_failed where it
/// cannot be read.
std::string read_text(const std::filesystem::path& path, std::size_t max_size, std::string_view expected);

}  // namespace zerocount

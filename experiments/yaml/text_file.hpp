#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
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

/// A format that is not text in UTF-8.
struct OtherFormat {
  std::string_view what;    ///< noun phrase: "a file compressed by gzip"
  std::string_view remedy;  ///< relative clause, how to get a text: "which 'gunzip' unpacks"; empty: none
};

/// The format of contents that are not text, by their first bytes: signatures of compressed files, archives,
/// workbooks and data files; the byte order marks of UTF-16 and UTF-32, and the zero bytes of UTF-16 without
/// one; otherwise four control characters, and one in twenty bytes. Nothing for a text, with the mark of
/// UTF-8 too.
std::optional<OtherFormat> other_format(std::string_view contents);

/// Refuses contents that are not text.
/// @throws Failure (bad_input) that names the format if the contents are not text.
/// @param name name of the file in messages
/// @param expected completes "expected", such as "a manifest"
void require_text(std::string_view name, std::string_view contents, std::string_view expected);

/// The text of a file or pipe, or of standard input for "-". Reads at most `max_size` + 1 bytes, so that the
/// caller can detect a text that is too long.
/// @param expected completes "expected", such as "a manifest"
/// @throws Failure: bad_input if the file does not exist, is a directory or device, or is not text, see
/// require_text(); machine_failed if it cannot be read.
std::string read_text(const std::filesystem::path& path, std::size_t max_size, std::string_view expected);

}  // namespace zerocount::yaml

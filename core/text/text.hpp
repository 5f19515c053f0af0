#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace zerocount::text {

/// A number with its noun: "1 trial", "2 trials", "0 trials".
/// @param noun noun in the singular; its plural must end in s.
std::string counted(std::integral auto count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// The text without the characters in `blanks` at both ends.
constexpr std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\n\v\f\r") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return text.substr(0, 0);
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// Numbers are read and written with std::from_chars and fmt, which know no locale. The functions of the C
// library (strtod, printf …) and streams take the decimal separator of the process, which an application that
// loads the extension of the Python package may have set to a comma.

/// Converts the whole text, in the notation of C, to a number; empty if it is not a number or does not fit
/// the type.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

/// `value` rounded to this number of significant decimal digits: for instance the double nearest to 2e-05,
/// not 1.9999999999999998e-05.
double round_to_digits(double value, int digits);

/// Whether a spreadsheet would take a cell with this text for a formula or a command: it begins with = or @,
/// or with a sign before something other than a number with a unit.
bool is_formula(std::string_view text);

/// The text as a field of a CSV file (RFC 4180): quoted where it holds a comma, a quote or a line break. A
/// text that a spreadsheet would take for a formula gets an apostrophe before it, so that it is shown as
/// text.
std::string csv_field(std::string_view text);

/// `word` as one word of a POSIX shell command: unchanged, or in single quotes if that is necessary.
std::string shell_word(const std::string& word);

/// The path as one word of a POSIX shell command, quoted if necessary. A path that begins with "-" gets "./"
/// before it, so that it is not taken for an option: "./-x.yaml". "-" alone is not changed.
std::string shell_path(const std::string& path);

/// The Unicode replacement character U+FFFD in UTF-8.
inline constexpr std::string_view replacement_utf8 = "\xEF\xBF\xBD";

struct CodePoint {
  char32_t value{0xFFFD};
  std::size_t bytes{1};
  bool valid{false};
};

/// The code point at the start of `text` (not empty); an invalid one takes one byte. Overlong forms,
/// surrogates and values beyond U+10FFFF are invalid (RFC 3629).
CodePoint decode(std::string_view text);

/// Whether a code point is a control character (C0, DEL, C1), a line or paragraph separator, or a character
/// that changes the direction of the text after it (Unicode Standard Annex 9: embeddings, overrides and
/// isolates), which can make a text read as another.
bool is_control(char32_t value);

/// Whether `text` is valid UTF-8 without control characters.
bool is_printable(std::string_view text);

/// `text` with each control character but line feeds and tabs, and each byte that is not UTF-8, replaced by
/// U+FFFD. For messages that repeat what a file or the user says.
std::string printable_lines(std::string_view text);

/// A file that is embedded in the program when it is built (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
  std::string_view name;  ///< Name of the file, such as "vega.min.js"
  std::string_view bytes;
};

}  // namespace zerocount::text

#include "tests/fuzz/expectation.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>

#include "core/failure/failure.hpp"
#include "core/text/utf8.hpp"

namespace zerocount::fuzz {
namespace {

[[noreturn]] void report(const std::string& reason, std::string_view text) {
  std::fprintf(stderr, "FINDING: %s: '%.*s'\n", reason.c_str(), static_cast<int>(text.size()), text.data());
  std::abort();
}

/// Bytes of the UTF-8 sequence that `first` begins; 0 if it begins none.
std::size_t sequence_length(std::uint8_t first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

/// The code point at the beginning of `text`, which is removed from it; none if it is not UTF-8 (RFC 3629).
std::optional<std::uint32_t> take_code_point(std::string_view& text) {
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const auto first = static_cast<std::uint8_t>(text.front());
  const std::size_t length = sequence_length(first);
  if (length == 0 || length > text.size()) return std::nullopt;
  std::uint32_t point = length == 1 ? first : first & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<std::uint8_t>(text[i]);
    if ((byte & 0xc0U) != 0x80U) return std::nullopt;
    point = point << 6U | (byte & 0x3fU);
  }
  const bool surrogate = point >= 0xd800 && point < 0xe000;
  if (point < smallest[length] || point > 0x10ffff || surrogate) return std::nullopt;
  text.remove_prefix(length);
  return point;
}

bool is_control(std::uint32_t point) {
  return point < 0x20 || (point >= 0x7f && point < 0xa0);
}

}  // namespace

void require_text(std::string_view text) {
  if (text.empty()) report("an empty text", text);
  for (std::string_view rest = text; !rest.empty();) {
    const std::optional<std::uint32_t> point = take_code_point(rest);
    if (!point) report("a text that is not UTF-8", text);
    if (is_control(*point) && *point != '\n' && *point != '\t')
      report("a text with control characters", text);
  }
}

void require_clear_refusal(const std::function<void()>& subject) {
  try {
    subject();
  } catch (const Failure& failure) {
    require_text(text::printable_lines(failure.what()));  // as the program prints it
    if (failure.code() != ExitCode::bad_input && failure.code() != ExitCode::bad_data)
      report("exit code " + std::to_string(static_cast<int>(failure.code())), failure.what());
  } catch (const std::exception& error) {
    report("an exception that is no Failure", error.what());
  }
}

}  // namespace zerocount::fuzz

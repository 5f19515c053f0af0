#include "runners/terminal/terminal.hpp"

#include <algorithm>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::terminal {
namespace {

/// Value of a variable of the environment, such as TERM; empty if it is not set.
std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

}  // namespace

std::optional<std::size_t> width_of(int descriptor) {
  constexpr std::size_t narrowest = 20;  // tables cannot be divided further
  constexpr std::size_t usual = 80;
  const bool terminal = isatty(descriptor) == 1;
  winsize size{};
  if (terminal && ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
    return std::max<std::size_t>(size.ws_col, narrowest);
  const auto stated = text::parse_number<std::size_t>(environment("COLUMNS"));
  if (!stated) return terminal ? std::optional(usual) : std::nullopt;
  return *stated == 0 ? std::nullopt : std::optional(std::max(*stated, narrowest));
}

bool obeys_escapes(int descriptor) {
  return isatty(descriptor) == 1 && environment("TERM") != "dumb";
}

std::string fitted_to(int descriptor, std::string_view text) {
  return text::fitted(text::printable_lines(text), width_of(descriptor));
}

}  // namespace zerocount::terminal

#include "runners/standard_output/standard_output.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>

#include <sys/ioctl.h>
#include <unistd.h>

#include "analysis/text/fitted_text.hpp"

namespace zerocount::standard_output {
namespace {

/// The number of columns that the environment states; 0 if it states none.
std::size_t columns_of_environment() {
  const char* const value = std::getenv("COLUMNS");
  std::size_t columns = 0;
  if (value != nullptr) std::from_chars(value, value + std::string_view(value).size(), columns);
  return columns;
}

}  // namespace

std::optional<std::size_t> terminal_width() {
  constexpr std::size_t narrowest = 20;  // tables cannot be divided further
  constexpr std::size_t usual = 80;
  if (isatty(STDOUT_FILENO) != 1) return std::nullopt;
  winsize size{};
  std::size_t columns = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
  if (columns == 0) columns = columns_of_environment();
  return std::max(columns == 0 ? usual : columns, narrowest);
}

void write_fitted(std::string_view text) {
  write(text::fitted(text::printable_lines(text), terminal_width()));
}

void write(std::string_view data) {
  std::string shown;
  if (isatty(STDOUT_FILENO) == 1) data = shown = text::printable_lines(data);
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size())
    throw std::system_error(errno, std::generic_category());
}

}  // namespace zerocount::standard_output

#include "runners/standard_output/standard_output.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <unistd.h>

#include "core/text/text.hpp"
#include "runners/terminal/terminal.hpp"

namespace zerocount::standard_output {

void write_fitted(std::string_view text) {
  write(terminal::fitted_to(STDOUT_FILENO, text));
}

void write(std::string_view data) {
  std::string shown;
  if (isatty(STDOUT_FILENO) == 1) data = shown = text::printable_lines(data);
  if (std::fwrite(data.data(), 1, data.size(), stdout) != data.size())
    throw std::system_error(errno, std::generic_category());
}

void flush() {
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category());
}

}  // namespace zerocount::standard_output

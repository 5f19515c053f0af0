#include "experiments/yaml/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::yaml {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, int error) {
  throw Failure(ExitCode::machine_failed,
                fmt::format("{}: cannot be read: {}", name_of_text(path), std::strerror(error)));
}

void require_file(const fs::path& path, std::string_view expected) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: no such file; expected {}", path.string(), expected));
  }
  if (fs::is_directory(status)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: this is a directory; expected {}", path.string(), expected));
  }
  if (!fs::is_regular_file(status) && !fs::is_fifo(status)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: this is not a regular file or pipe; expected {}",
                                                   path.string(), expected));
  }
}

std::string read_stream(const fs::path& path, std::FILE* stream, std::size_t max_size) {
  std::string text;
  std::array<char, 65536> block{};
  while (text.size() <= max_size) {
    const std::size_t size = std::fread(block.data(), 1, block.size(), stream);
    text.append(block.data(), size);
    if (size == block.size()) continue;
    if (std::ferror(stream) != 0) fail_to_read(path, errno);
    break;
  }
  if (text.size() > max_size) text.resize(max_size + 1);
  return text;
}

}  // namespace

bool is_standard_stream(const fs::path& path) {
  return path == "-";
}

bool is_stream(const fs::path& path) {
  std::error_code error;
  return is_standard_stream(path) || fs::is_fifo(path, error);
}

std::string name_of_text(const fs::path& path) {
  return is_standard_stream(path) ? "<stdin>" : path.string();
}

std::string read_text(const fs::path& path, std::size_t max_size, std::string_view expected) {
  if (is_standard_stream(path)) return read_stream(path, stdin, max_size);
  require_file(path, expected);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) fail_to_read(path, errno);
  return read_stream(path, file.get(), max_size);
}

}  // namespace zerocount::yaml

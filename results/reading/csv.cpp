#include "results/reading/csv.hpp"

#include <array>
#include <cerrno>
#include <charconv>

#include <fcntl.h>

namespace zerocount {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> text{};  // the longest double takes 24
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

CsvFile::CsvFile(const std::filesystem::path& path)
    : path_(path),
      part_(path),
      file_(::open(part_.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (!file_.valid()) fail_with(path_, "write", errno);
}

void CsvFile::separate() {
  if (row_started_) buffer_ += ',';
  row_started_ = true;
}

void CsvFile::add(double value) {
  separate();
  buffer_ += number_text(value);
}

void CsvFile::add(std::int64_t value) {
  separate();
  buffer_ += std::to_string(value);
}

void CsvFile::add(std::string_view text) {
  separate();
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    buffer_ += text;
    return;
  }
  buffer_ += '"';
  for (const char character : text) {
    if (character == '"') buffer_ += '"';
    buffer_ += character;
  }
  buffer_ += '"';
}

void CsvFile::end_row() {
  buffer_ += '\n';
  row_started_ = false;
  if (buffer_.size() >= buffer_size) flush();
}

void CsvFile::flush() {
  write_all(path_, file_, buffer_);
  buffer_.clear();
}

void CsvFile::finish() {
  flush();
  publish(path_);
}

}  // namespace zerocount

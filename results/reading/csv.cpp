#include "results/reading/csv.hpp"

#include <cerrno>
#include <cmath>

#include <fcntl.h>
#include <fmt/format.h>

namespace zerocount {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;

}  // namespace

std::string number_text(double value) {
  return std::isnan(value) ? "nan" : fmt::format("{}", value);  // a NaN's sign means nothing
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + '"';
}

std::string head_with_unit(std::string_view name, std::string_view unit) {
  return unit.empty() || unit == "1" ? std::string(name) : fmt::format("{} [{}]", name, unit);
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
  buffer_ += csv_field(text);
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
  if (::fsync(file_.get()) != 0) fail_with(path_, "write", errno);
}

void CsvFile::publish() {
  zerocount::publish(path_);
}

}  // namespace zerocount

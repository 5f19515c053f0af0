#include "results/storage/output_file.hpp"

#include <cerrno>
#include <span>

#include <fmt/format.h>
#include <unistd.h>

#include "core/failure/failure.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::storage {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 16;

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : path_(path), part_(part_of(path)) {
  require_replaceable(path);
  file_ = create_file(part_);
}

OutputFile::~OutputFile() {
  if (is_named(file_, part_)) ::unlink(part_.c_str());
}

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::flush() {
  write_all(part_, file_, buffer_);
  written_.add(std::as_bytes(std::span(buffer_)));
  size_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::finish() {
  flush();
  synchronise(part_, file_);
  if (::lseek(file_.get(), 0, SEEK_SET) != 0) fail_with(part_, "read back", errno);
  const bool same =
      size_of_file(part_, file_) == size_ && sha256_of(part_, file_, size_) == written_.digest();
  if (!same) fail_read_back(part_, "its bytes differ");
}

void OutputFile::finish_with_checksum() {
  flush();
  hash::Sha256Hash contents = written_;  // a digest ends a hash
  write(checksum_trailer(contents.digest()));
  finish();
}

void OutputFile::publish() {
  if (!is_named(file_, part_)) {
    throw Failure(
        ExitCode::machine_failed,
        fmt::format("{}: another command is writing this output; give the command again when it has "
                    "ended, or name another output",
                    path_.string()));
  }
  storage::publish(path_);
}

}  // namespace zerocount::storage

#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>

#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::testing {

/// Appends the checksum trailer to a file that a test has made or changed.
inline void append_checksum(const std::filesystem::path& path) {
  const storage::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  const hash::Sha256 checksum = storage::sha256_of(path, file, storage::size_of_file(path, file));
  std::ofstream end(path, std::ios::binary | std::ios::app);
  end << storage::checksum_trailer(checksum);
  if (!end.flush()) throw std::runtime_error(path.string() + ": no checksum was written");
}

}  // namespace zerocount::testing

#include "tests/fuzz/memory_file.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <sys/mman.h>
#include <unistd.h>

namespace zerocount::fuzz {

MemoryFile::MemoryFile() : file_(memfd_create("input", MFD_CLOEXEC)) {
  if (!file_.valid()) {
    std::perror("memfd_create");
    std::abort();
  }
  path_ = "/proc/self/fd/" + std::to_string(file_.get());
}

void MemoryFile::replace(std::string_view bytes) {
  const bool written = ::ftruncate(file_.get(), 0) == 0 &&
                       ::pwrite(file_.get(), bytes.data(), bytes.size(), 0) == std::ssize(bytes);
  if (written) return;
  std::perror("writing a file in memory");
  std::abort();
}

std::string MemoryFile::bytes() const {
  std::ifstream file(path_, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace zerocount::fuzz

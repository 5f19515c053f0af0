#include "tests/support/temporary_folder.hpp"

#include <fstream>
#include <iterator>

namespace zerocount::testing {

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::filesystem::path TemporaryFolder::write(const std::string& name, const std::string& bytes) const {
  write_bytes(*this / name, bytes);
  return *this / name;
}

std::string TemporaryFolder::read(const std::string& name) const {
  return read_bytes(*this / name);
}

}  // namespace zerocount::testing

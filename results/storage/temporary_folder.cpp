#include "results/storage/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "results/storage/durable_file.hpp"

namespace zerocount::storage {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  if (error) fail_with("the folder for temporary files (TMPDIR)", "find it", error.value());
  std::string pattern = (place / "zerocount-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) fail_with(pattern, "make the folder", errno);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace zerocount::storage

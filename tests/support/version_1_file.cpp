#include "tests/support/version_1_file.hpp"

#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

namespace zerocount::testing {

std::filesystem::path version_1_file(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "version-1.h5";
  const std::string command =
      fmt::format("{} -c 'import lzma, sys; sys.stdout.buffer.write(lzma.open(sys.argv[1]).read())' {} > {}",
                  ZEROCOUNT_PYTHON, ZEROCOUNT_VERSION_1_FILE, file.string());
  if (std::system(command.c_str()) != 0) throw std::runtime_error("cannot unpack the file of version 1");
  return file;
}

}  // namespace zerocount::testing

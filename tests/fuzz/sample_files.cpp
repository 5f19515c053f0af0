#include "tests/fuzz/sample_files.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace zerocount::fuzz {

namespace fs = std::filesystem;

std::vector<std::string> sample_files(std::string_view target) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path() / "files" / target;
  std::vector<fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> contents;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    contents.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  if (!contents.empty()) return contents;
  std::fprintf(stderr, "no files in %s\n", folder.c_str());
  std::exit(2);
}

}  // namespace zerocount::fuzz

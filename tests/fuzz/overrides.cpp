// Feeds the texts of --set to sample manifests: the first byte chooses one, each line that follows is an
// override.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/sample_files.hpp"
#include "tests/fuzz/study_use.hpp"

namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace zerocount;
  static const std::vector<std::string> manifests = fuzz::sample_files("overrides");
  if (size == 0) return 0;
  const std::string& text = manifests[data[0] % manifests.size()];
  const std::vector<std::string> overrides = lines_of({reinterpret_cast<const char*>(data + 1), size - 1});
  fuzz::require_clear_refusal([&] { fuzz::use_study(manifest::parse_study(text, "study.yaml", overrides)); });
  return 0;
}

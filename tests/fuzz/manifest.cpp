// Feeds a manifest, and below a line "%%%" the table that its key `samples` names.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/study_use.hpp"
#include "tests/fuzz/theory_use.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace zerocount;
  constexpr std::string_view mark = "\n%%%\n";
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t place = input.find(mark);
  const std::string table(place == std::string_view::npos ? "" : input.substr(place + mark.size()));
  fuzz::require_clear_refusal([&] {
    const study::Study study =
        manifest::parse_study(std::string(input.substr(0, place)), "study.yaml", {},
                              {.samples = [&](const std::string&, std::string_view) { return table; }});
    fuzz::use_study(study);
    fuzz::use_theory(study);
  });
  return 0;
}

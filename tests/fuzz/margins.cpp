// Feeds the file of margins and requirements of `zerocount compare`.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "analysis/pairs/comparison/gate_rules.hpp"
#include "tests/fuzz/expectation.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace zerocount;
  static const std::array<std::string, 4> labels{"a", "kp=0.0003, ki=1e-05", "with: colon", ""};
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::require_clear_refusal([&] {
    const comparison::GateRules rules = comparison::parse_gate_rules(text, "margins.yaml", labels);
    for (const std::string& label : labels) {
      comparison::requirements_of(rules, label);
      for (const comparison::GateMeasure& measure :
           comparison::judged_measures(rules, layout::measure_table(), {{"", true}}))
        comparison::margin_of(rules, label, measure);
    }
  });
  return 0;
}

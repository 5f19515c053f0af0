#include "runners/controller_code/heading.hpp"

#include <fmt/format.h>

#include "core/loop/dac.hpp"

namespace zerocount::controller_code {

std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision) {
  const std::string torque = parameters::unit_on(chain.axis, "N m");
  const std::string force = parameters::text_on(chain.axis, "$torque");
  std::vector<std::string> lines{
      fmt::format("The controller of the study {}, as zerocount simulates it.", chain.name), "",
      fmt::format("One step at each sample, {} Hz. Counts are those of an encoder of {} {} a count.",
                  chain.controller.sample_rate, chain.resolution, parameters::unit_on(chain.axis, "rad")),
      fmt::format(
          "The wanted {} is in {}. The converter behind it rounds it to steps of {} {} and limits it to",
          force, torque, chain.dac.resolution, torque),
      fmt::format(
          "{:.6g} ... {:.6g} {}; what it gave at the sample before is the input `torque` of the next.",
          loop::lowest_torque(chain.dac), loop::highest_torque(chain.dac), torque)};
  lines.insert(lines.end(), chain.remarks.begin(), chain.remarks.end());
  lines.emplace_back("");
  if (precision == Precision::double_precision) {
    lines.emplace_back("The constants are exact, and the operations in the order of the simulation: without");
    lines.emplace_back(
        "contracted or reordered operations (-ffp-contract=off, no -ffast-math) it computes the same");
    lines.emplace_back("bits.");
  } else {
    lines.emplace_back("In single precision: the constants are rounded to it, and counts are whole numbers.");
  }
  return lines;
}

}  // namespace zerocount::controller_code

#include <fmt/format.h>

#include "analysis/record/experiment_design/experiment_design.hpp"
#include "analysis/record/experiment_design/torque_protocol.hpp"

namespace zerocount::experiment_design {
namespace {

/// A text table with a row for each sample: time, torque, and the result of `last(sample)`.
/// @param last_name head of the last column
template <class Last>
std::string table_of(const ExperimentDesign& design, std::string_view last_name, const Last& last) {
  const TorqueProtocol& protocol = design.protocol;
  std::string text = fmt::format("t [s],{} [{}],{}\n", parameters::text_on(design.frame.axis, "$torque"),
                                 parameters::unit_on(design.frame.axis, "N m"), last_name);
  for (std::size_t k = 0; k < protocol.torque.size(); ++k) {
    text +=
        fmt::format("{},{},{}\n", static_cast<double>(k) * protocol.sample_time, protocol.torque[k], last[k]);
  }
  return text;
}

}  // namespace

std::string protocol_table(const ExperimentDesign& design) {
  return table_of(design, "code", design.protocol.codes);
}

std::string record_table(const ExperimentDesign& design) {
  return table_of(design, "count", design.record.counts);
}

std::string streamer_file(const TorqueProtocol& protocol) {
  std::string text;
  for (const double torque : protocol.torque) text += fmt::format("{}\n", torque);
  return text;
}

}  // namespace zerocount::experiment_design

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount::report {

/// A block of the axis: its name, and its main numbers with their units, a line each.
struct DiagramBlock {
  std::string title;
  std::vector<std::string> lines;
};

/// The axis as blocks in the direction of the signals: reference → controller → drive → plant → encoder,
/// which closes the loop.
struct AxisDiagram {
  DiagramBlock reference;                     ///< of an open loop the levels of the torque
  std::optional<DiagramBlock> controller{};   ///< none of an open loop
  DiagramBlock drive;                         ///< converter and amplifier
  DiagramBlock plant;                         ///< motor and moved mass, with the load if there is one
  std::optional<DiagramBlock> friction{};     ///< none without friction
  std::optional<DiagramBlock> disturbance{};  ///< none without disturbances
  DiagramBlock encoder;
};

/// The axis of a design point: what is on in some trial under some condition.
AxisDiagram axis_diagram(const study::Study& study, std::int64_t point);

}  // namespace zerocount::report

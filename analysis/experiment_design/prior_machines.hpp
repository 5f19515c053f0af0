#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/experiment_design/torque_protocol.hpp"
#include "analysis/identification/contact_coordinates.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::experiment_design {

/// A machine that the manifest allows. Its contact is unloaded and virgin at the start.
struct Machine {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  trial::TrialParameters parameters;
  identification::ContactParameters contact;  ///< where the test is made
};

/// The machine with the median of each quantity that the manifest draws.
Machine median_machine(const study::Study& study, std::int64_t point);

/// The first `count` machines of the study at the point: its rigs, or the trials of a study without rigs. All
/// of them if there are fewer.
std::vector<Machine> drawn_machines(const study::Study& study, std::int64_t point, std::int64_t count);

/// The record of a machine under a protocol.
struct SimulatedRecord {
  std::vector<std::int64_t> counts;  ///< [sample] of the fine encoder
  std::vector<double> angle;         ///< [sample] of the rotor, rad
  double travel{0.0};                ///< largest |angle|, rad
  bool slid{false};                  ///< the friction broke away
};

/// Runs a trial of core under the protocol, with all errors of encoder and converter that the manifest has.
SimulatedRecord simulate(const Machine& machine, const TorqueProtocol& protocol);

}  // namespace zerocount::experiment_design

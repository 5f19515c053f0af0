#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/record/experiment_design/torque_protocol.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

/// Expected results of `identify` on simulated records. This is the only place that depends on how `identify`
/// reads and fits a record.
namespace zerocount::experiment_design {

/// A machine that the manifest allows. Its friction contact is unloaded and virgin (never loaded before) at
/// the start.
struct Machine {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  trial::TrialParameters parameters;
  fit::ContactParameters contact;  ///< Parameters of the friction contact at the position of the test.
};

/// The median machine: each quantity that the manifest draws has its median.
/// @param point index of the design point
Machine median_machine(const study::Study& study, std::int64_t point);

/// The first `count` machines of the study at the design point; in a study without machines, those of its
/// first trials. All of them if there are fewer.
std::vector<Machine> drawn_machines(const study::Study& study, std::int64_t point, std::int64_t count);

/// Simulated record of a machine under a torque protocol.
struct SimulatedRecord {
  std::vector<std::int64_t> counts;  ///< [sample] Count that the fine encoder reads.
  std::vector<double> angle;         ///< [sample] Angle of the rotor, rad.
  double travel{0.0};                ///< Largest |angle| of the rotor in the record, rad.
  bool slid{false};                  ///< True if the friction broke away, so that the rotor slid.
};

/// Simulates the machine under the torque protocol, with all errors of encoder and converter that the
/// manifest has.
SimulatedRecord simulate(const Machine& machine, const TorqueProtocol& protocol);

/// Half-widths of the 95 % intervals of the parameters with a manifest key, in the order of
/// fit::coordinate_keys. They refer to the logarithm of the parameter; for the creep exponent n to n itself.
/// Infinite for parameters that the machine does not have (creep).
using Widths = std::vector<double>;

/// The simulated record as `identify` would read it from a file.
/// @throws Failure (bad_data) if `identify` would refuse it.
fit::TestRecord test_record_of(const Machine& machine, const TorqueProtocol& protocol,
                               const SimulatedRecord& simulated);

/// Criterion for the precision of the parameters by linear theory; smaller is better. Mean of the logarithms
/// of the standard deviations of ln k1, ln k2, ln β, ln c, ln J, ln α, ln λ and n, which follow from the
/// information matrix at the machine's own parameters.
double log_spread(const Machine& machine, const TorqueProtocol& protocol, const SimulatedRecord& simulated);

/// The half-widths of the intervals that `identify` would report for the record. Replicates of the readings
/// are fitted in the model linearised at the machine's own parameters, as `identify` does at its fit.
Widths expected_widths(const Machine& machine, const TorqueProtocol& protocol,
                       const SimulatedRecord& simulated);

/// Identifies the friction parameters from the simulated record, as the command `identify` would.
/// @param report called with the name of each stage
/// @throws Failure (bad_data) if `identify` refuses the record
fit::Identification identified(const Machine& machine, const TorqueProtocol& protocol,
                               const SimulatedRecord& simulated, const fit::StageReport& report);

}  // namespace zerocount::experiment_design

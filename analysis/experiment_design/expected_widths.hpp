#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment_design/torque_protocol.hpp"
#include "analysis/fit/presliding/contact.hpp"
#include "analysis/fit/presliding/identification.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

/// Expected results of `identify` on simulated records. This is the only place that depends on how `identify`
/// reads and fits a record.
namespace zerocount::experiment_design {

/// A machine that the manifest allows. Its contact is unloaded and virgin at the start.
struct Machine {
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  trial::TrialParameters parameters;
  fit::ContactParameters contact;  ///< Parameters of the contact at the position of the test.
};

/// The machine with the median of each quantity that the manifest draws.
Machine median_machine(const study::Study& study, std::int64_t point);

/// The first `count` machines of the study at the point: its machines, or the trials of a study without
/// machines. All of them if there are fewer.
std::vector<Machine> drawn_machines(const study::Study& study, std::int64_t point, std::int64_t count);

/// The record of a machine under a protocol.
struct SimulatedRecord {
  std::vector<std::int64_t> counts;  ///< [sample] Count of the fine encoder.
  std::vector<double> angle;         ///< [sample] Angle of the rotor, rad.
  double travel{0.0};                ///< Largest |angle|, rad.
  bool slid{false};                  ///< True if the friction broke away.
};

/// Runs a trial of core under the protocol, with all errors of encoder and converter that the manifest has.
SimulatedRecord simulate(const Machine& machine, const TorqueProtocol& protocol);

/// Half-widths of the 95 % intervals of the parameters with a manifest key, in the order of
/// fit::coordinate_keys. They refer to the logarithm of the parameter, for n to the parameter itself.
/// Infinite for parameters that the machine does not have (creep).
using Widths = std::vector<double>;

/// The simulated record as `identify` would read it from a file.
/// @throws Failure (bad_data) if `identify` would refuse it.
fit::TestRecord test_record_of(const Machine& machine, const TorqueProtocol& protocol,
                               const SimulatedRecord& simulated);

/// Criterion for the precision of the parameters by linear theory: mean of the logarithms of the standard
/// deviations of ln k1, ln k2, ln β, ln c, ln J, ln α, ln λ and n. They follow from the information matrix at
/// the machine's own parameters.
double log_spread(const Machine& machine, const TorqueProtocol& protocol, const SimulatedRecord& simulated);

/// The widths of the intervals that `identify` would report, by replicates of the readings in the model
/// linearised at the machine's own parameters, as `identify` makes them at its fit.
Widths expected_widths(const Machine& machine, const TorqueProtocol& protocol,
                       const SimulatedRecord& simulated);

/// Identifies the record.
/// @throws Failure (bad_data) if `identify` refuses it.
fit::Identification identified(const Machine& machine, const TorqueProtocol& protocol,
                               const SimulatedRecord& simulated, const fit::StageReport& report);

}  // namespace zerocount::experiment_design

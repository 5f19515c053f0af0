#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/experiment_design/prior_machines.hpp"
#include "analysis/identification/identification.hpp"

/// The only place that knows how `identify` reads and fits a record.
namespace zerocount::experiment_design {

/// Half-widths of the 95 % intervals of the parameters with a manifest key, in the order of
/// identification::coordinate_keys: of the logarithm, of n itself. Infinite for what the machine does not
/// have (creep).
using Widths = std::vector<double>;

/// The record as `identify` would read it from a file.
/// @throws Failure (bad_data) if `identify` would refuse it.
identification::TestRecord test_record_of(const Machine& machine, const TorqueProtocol& protocol,
                                          const SimulatedRecord& simulated);

/// How narrow the parameters come out by the linear theory: mean of the logarithms of the standard deviations
/// of ln k1, ln k2, ln β, ln c, ln J, ln α, ln λ and n, from the information matrix at the machine's own
/// parameters.
double log_spread(const Machine& machine, const TorqueProtocol& protocol, const SimulatedRecord& simulated);

/// The widths of the intervals that `identify` would report, by replicates of the readings in the model
/// linearised at the machine's own parameters, as `identify` makes them at its fit.
Widths expected_widths(const Machine& machine, const TorqueProtocol& protocol,
                       const SimulatedRecord& simulated);

/// Identifies the record.
/// @throws Failure (bad_data) if `identify` refuses it.
identification::Identification identified(const Machine& machine, const TorqueProtocol& protocol,
                                          const SimulatedRecord& simulated,
                                          const identification::StageReport& report);

}  // namespace zerocount::experiment_design

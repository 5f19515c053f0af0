#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/experiment_design/protocol_search.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::experiment_design {

struct DesignSettings {
  std::int64_t point{0};
  double duration{10.0};  ///< Duration of the record, s.
  /// Largest torque as a proportion of the smallest breakaway torque of the machines.
  double max_torque{0.7};
  double max_travel{std::numeric_limits<double>::infinity()};  ///< Largest allowed |angle|, rad.
  std::int64_t machines{16};  ///< Number of machines besides the median machine.
  SearchSettings search;
  fit::StageReport report{};
};

/// Expected estimate of a parameter.
struct ExpectedParameter {
  std::string key;               ///< Manifest key of the parameter.
  std::string unit;              ///< Unit on this kind of axis.
  double guess{0.0};             ///< Value of the median machine.
  fit::ParameterEstimate found;  ///< Estimate from the simulated record of the median machine.
  /// Narrowest relative half-width of the interval over the machines on which the parameter can be
  /// identified.
  double narrowest{0.0};
  double widest{0.0};    ///< Widest relative half-width of the interval over these machines.
  std::int64_t told{0};  ///< Number of machines on which the parameter can be identified.
};

/// A designed experiment.
struct ExperimentDesign {
  std::string study;
  ProtocolFrame frame;
  ProtocolShape shape;
  std::vector<ProtocolSegment> segments;
  TorqueProtocol protocol;
  double least_breakaway{0.0};  ///< Smallest breakaway torque of all machines, N m.
  double travel{0.0};           ///< Largest |angle| on any machine, rad.
  std::int64_t machines{0};     ///< Number of machines, including the median machine.
  SearchResult search;
  Machine median;
  SimulatedRecord record;  ///< Simulated record of the median machine.
  fit::Identification identification;
  std::vector<ExpectedParameter> parameters;
};

/// @throws Failure: bad_input if the friction has another model than presliding or spring, the machine a
/// second mass, the record no room for its parts, or no torque is safe; inconclusive if `identify` refuses
/// the simulated record.
ExperimentDesign design_experiment(const study::Study& study, const DesignSettings& settings);

/// The commanded torque as a table for the axis' controller: time, torque and DAC code. `identify` reads it
/// once it has a column of counts.
std::string protocol_table(const ExperimentDesign& design);

/// The torque for LinuxCNC's `streamer` with cfg=f: a line for each sample, at the rate of its thread.
std::string streamer_file(const TorqueProtocol& protocol);

/// The simulated record of the median machine, as `identify` reads it.
std::string record_table(const ExperimentDesign& design);

/// A protocol for recording an axis: the tests, the expected results on given machines, and the
/// identification.
document::Description<ExperimentDesign> design_description();

}  // namespace zerocount::experiment_design

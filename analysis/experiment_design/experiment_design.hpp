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
  double duration{10.0};   ///< s
  double max_torque{0.7};  ///< proportion of the smallest breakaway torque of the machines
  double max_travel{std::numeric_limits<double>::infinity()};  ///< rad
  std::int64_t machines{16};                                   ///< besides the median one
  SearchSettings search;
  fit::StageReport report{};
};

/// Expected estimate of a parameter.
struct ExpectedParameter {
  std::string key;               ///< in a manifest
  std::string unit;              ///< on this kind of axis
  double guess{0.0};             ///< of the median machine
  fit::ParameterEstimate found;  ///< from the simulated record of the median machine
  /// Narrowest and widest relative half-width of the interval over the machines on which it can be told.
  double narrowest{0.0};
  double widest{0.0};
  std::int64_t told{0};  ///< on how many of the machines
};

/// A designed experiment.
struct ExperimentDesign {
  std::string study;
  ProtocolFrame frame;
  ProtocolShape shape;
  std::vector<ProtocolSegment> segments;
  TorqueProtocol protocol;
  double least_breakaway{0.0};  ///< N m, of all machines
  double travel{0.0};           ///< largest |angle| on any machine, rad
  std::int64_t machines{0};     ///< with the median one
  SearchResult search;
  Machine median;
  SimulatedRecord record;  ///< of the median machine
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

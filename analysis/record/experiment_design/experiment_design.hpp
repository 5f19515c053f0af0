#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/document/description.hpp"
#include "analysis/record/experiment_design/protocol_search.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::experiment_design {

struct DesignSettings {
  std::int64_t point{0};
  double duration{10.0};  ///< Duration of the record that the experiment is to give, s.
  /// Largest torque that the protocol may use, as a proportion of the smallest breakaway torque of the
  /// machines.
  double max_torque{0.7};
  /// Largest |angle| to which the protocol may turn any machine, rad; infinite: no limit.
  double max_travel{std::numeric_limits<double>::infinity()};
  /// Number of machines drawn from the manifest in addition to the median machine.
  std::int64_t machines{16};
  SearchSettings search;
  fit::StageReport report{};
};

/// Expected estimate of one parameter from the designed experiment.
struct ExpectedParameter {
  std::string key;               ///< Manifest key of the parameter.
  std::string unit;              ///< Unit of the parameter on this kind of axis (rotary or linear).
  double guess{0.0};             ///< Value of the parameter on the median machine.
  fit::ParameterEstimate found;  ///< Estimate from the simulated record of the median machine.
  /// Narrowest relative half-width (half-width divided by value) of the 95 % interval over the machines on
  /// which the parameter can be identified.
  double narrowest{0.0};
  /// Widest relative half-width of the 95 % interval over the machines on which the parameter can be
  /// identified.
  double widest{0.0};
  std::int64_t told{0};  ///< Number of machines on which the parameter can be identified.
};

/// A designed experiment: the torque protocol, and the results to be expected from it.
struct ExperimentDesign {
  std::string study;
  ProtocolFrame frame;
  ProtocolShape shape;
  std::vector<ProtocolSegment> segments;
  TorqueProtocol protocol;
  double least_breakaway{0.0};  ///< Smallest breakaway torque of all these machines, N m.
  double travel{0.0};           ///< Largest |angle| of any machine under the protocol, rad.
  /// Number of machines for which the protocol was designed, including the median machine.
  std::int64_t machines{0};
  SearchResult search;
  Machine median;
  SimulatedRecord record;  ///< Simulated record of the median machine.
  fit::Identification identification;
  std::vector<ExpectedParameter> parameters;
};

/// Designs an experiment that identifies the friction of the study's axis before it slides: searches the best
/// torque protocol, and simulates its record.
/// @throws Failure: bad_input if the friction has another model than presliding or spring, the axis has a
/// second mass, the record is too short for its parts, or no torque is safe; inconclusive if `identify`
/// refuses the simulated record.
ExperimentDesign design_experiment(const study::Study& study, const DesignSettings& settings);

/// The commanded torque as a text table for the axis' controller: time, torque and DAC code. `identify` can
/// read the table after a column of counts has been added.
std::string protocol_table(const ExperimentDesign& design);

/// The torque as a text for LinuxCNC's `streamer` with cfg=f (one float per line): a line for each sample, at
/// the rate of its thread.
std::string streamer_file(const TorqueProtocol& protocol);

/// The simulated record of the median machine as a text table, which `identify` can read.
std::string record_table(const ExperimentDesign& design);

/// Description of the answer: the protocol for recording an axis, the expected results on given machines, and
/// the identification.
document::Description<ExperimentDesign> design_description();

}  // namespace zerocount::experiment_design

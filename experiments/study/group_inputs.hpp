#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The inputs (drawn parameters) that all trials of one group share, such as all trials of one machine,
/// indexed by the columns of InputColumns::shared, each in the unit of its column.
/// @throws Failure (bad_input) for a group that the study does not have
std::vector<double> group_inputs(const Study& study, Grouping grouping, std::int64_t group);

/// A parameter that is drawn for each world, with its values. A world is one possible set of the values that
/// nobody knows and all machines share.
struct WorldValues {
  std::string name;  ///< dotted path of the parameter
  std::string unit;
  std::vector<double> values;  ///< [world] value, in `unit`
};

/// The parameters that are drawn once per world at a design point, with their values, including distributions
/// that the sweep gives. A world is one possible set of the values that nobody knows and all machines share.
/// Empty without worlds.
std::vector<WorldValues> world_values(const Study& study, std::int64_t point);

/// Whether a parameter differs between machines but not between the moves of one machine. This holds if it is
/// drawn per world or per machine. In a study without machines it also holds if it is drawn per trial, unless
/// it belongs to the command or to the initial conditions.
/// @param level how often the parameter is drawn
/// @param name dotted path
bool differs_between_machines(const Study& study, DrawLevel level, std::string_view name);

/// A drawn quantity that differs between machines: one parameter, or a row of joint samples.
struct MachineInput {
  /// Dotted path of the parameter; for a row of joint samples all their paths, joined by ", ".
  std::string name;
  std::vector<std::uint32_t> slots;  ///< slots (parameters in the plan) whose values share one random number
};

/// The drawn quantities in which the machines of a design point differ (differs_between_machines), without
/// parameters that vary along the axis. A row of joint samples is listed as a whole if one of its values
/// differs between machines.
std::vector<MachineInput> machine_inputs(const Study& study, std::int64_t point);

/// The values of the parameters in `input` at this quantile: pairs of dotted path and value in the unit of
/// the manifest.
std::vector<std::pair<std::string, double>> values_at_quantile(const Study& study, std::int64_t point,
                                                               const MachineInput& input, double quantile);

/// [input] the quantile in (0, 1) that trial `index` has drawn for the input.
std::vector<double> drawn_quantiles(const Study& study, std::int64_t point, std::int64_t index,
                                    const std::vector<MachineInput>& inputs);

}  // namespace zerocount::study

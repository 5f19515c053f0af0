#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The inputs that all trials of a group share: [column of InputColumns::shared], in that column's unit.
/// @throws Failure (bad_input) for a group that the study does not have
std::vector<double> group_inputs(const Study& study, Grouping grouping, std::int64_t group);

/// A value that is drawn for each world.
struct WorldValues {
  std::string name;  ///< dotted path
  std::string unit;
  std::vector<double> values;  ///< [world]
};

/// The values drawn per world at a design point, those of the sweep included; empty without worlds.
std::vector<WorldValues> world_values(const Study& study, std::int64_t point);

/// Whether a value that is drawn so often differs between machines but not between the moves of one: drawn
/// per world or machine; without machines also per trial, unless it is of the command or the initial
/// conditions.
/// @param name dotted path
bool differs_between_machines(const Study& study, DrawLevel level, std::string_view name);

/// A drawn quantity of a machine.
struct MachineInput {
  std::string name;                  ///< dotted path; of joint samples the paths, joined by ", "
  std::vector<std::uint32_t> slots;  ///< that share its random number
};

/// The drawn quantities in which the machines of a point differ: those drawn per machine; without machines
/// those drawn per trial that are not of the command or the initial conditions. Profiles are not among them.
/// A row of joint samples is of the machine as a whole if one of its values is.
std::vector<MachineInput> machine_inputs(const Study& study, std::int64_t point);

/// The values of an input's slots at this quantile, in the units of the manifest: (dotted path, value).
std::vector<std::pair<std::string, double>> values_at_quantile(const Study& study, std::int64_t point,
                                                               const MachineInput& input, double quantile);

/// The quantile of each of these inputs that trial `index` has drawn.
std::vector<double> drawn_quantiles(const Study& study, std::int64_t point, std::int64_t index,
                                    const std::vector<MachineInput>& inputs);

}  // namespace zerocount::study

#pragma once

#include <vector>

#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {

/// The rules between the values of the list and the parameters of the command: the number of samples of a
/// trial; of a sequence, the order of its targets; with a profile, the time that the reference travels; of
/// torque levels, the range of the converter.
std::vector<ValueRule> command_rules(const study::StudyPlan& plan);

}  // namespace zerocount::rules

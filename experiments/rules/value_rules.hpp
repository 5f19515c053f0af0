#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/point_limits.hpp"

namespace zerocount {

/// What is wrong between values at a design point.
struct ValueFault {
  std::string what;
  std::string expected;
  std::vector<std::size_t> listed{};  ///< the values of the list that it is between, the first one leading;
                                      ///< none: the parameters of the rule alone
};

/// What the limits of some parameters at a design point must be to one another.
struct ValueRule {
  std::vector<std::string_view> between;  ///< the parameters; the first gives a message its path
  bool whole_list{false};                 ///< and all values of the list
  std::function<std::vector<ValueFault>(std::span<const ValueLimits> parameters,
                                        std::span<const ValueLimits> list)>
      find_faults;  ///< from the limits of the parameters in their order, and of the list where it is wanted
  bool warn_only{false};
};

/// The rules for a plan of this kind.
std::vector<ValueRule> value_rules(const StudyPlan& plan);

}  // namespace zerocount

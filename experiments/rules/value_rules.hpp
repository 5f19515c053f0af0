#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/study/point_edit.hpp"
#include "experiments/study/point_limits.hpp"

namespace zerocount::rules {

/// An inconsistency between values at a design point.
struct ValueFault {
  std::string what;
  std::string expected;
  std::vector<std::size_t> listed{};  ///< the involved values of the list, the first one for the message;
                                      ///< empty: only the parameters of the rule
};

/// A condition on the limits of several parameters at a design point.
struct ValueRule {
  std::vector<std::string_view> between;  ///< the parameters; the first one gives the path of the message
  bool whole_list{false};                 ///< the rule also involves all values of the list
  std::function<std::vector<ValueFault>(std::span<const study::ValueLimits> parameters,
                                        std::span<const study::ValueLimits> list)>
      find_faults;  ///< from the limits of the parameters in their order, and of the list if whole_list
  bool warn_only{false};
  bool once{false};       ///< only the first fault is reported, at the parameter of the rule that is given
  bool of_record{false};  ///< the message is about record_key(), which is not a parameter
};

/// A rule of the limits of these parameters, which `find_faults` takes as arguments of its own in their
/// order, so that the compiler counts them.
template <std::size_t count, class FindFaults>
ValueRule between(const std::string_view (&names)[count], FindFaults find_faults) {
  return {{names, names + count},
          false,
          [find_faults](std::span<const study::ValueLimits> parameters, std::span<const study::ValueLimits>) {
            return [&]<std::size_t... i>(std::index_sequence<i...>) {
              return find_faults(parameters[i]...);
            }
            (std::make_index_sequence<count>{});
          }};
}

inline ValueRule warning(ValueRule rule) {
  rule.warn_only = true;
  return rule;
}

/// The key of the record that stands in place of levels or targets.
std::string_view record_key(const study::StudyPlan& plan);

/// The rules between the values of the list and the parameters of the command: the number of samples of a
/// trial; of a sequence, the order of its targets; with a profile, the time that the reference travels; of
/// torque levels, the range of the converter.
std::vector<ValueRule> command_rules(const study::StudyPlan& plan);

/// The rules between the values of lists: the elements of the generalised Maxwell-slip model, and filters.
std::vector<ValueRule> list_rules(const study::StudyPlan& plan);

/// The rules for a study whose controller is a plugin.
std::vector<ValueRule> plugin_rules(const study::StudyPlan& plan);

/// All rules for a plan of this kind.
std::vector<ValueRule> value_rules(const study::StudyPlan& plan);

/// The rule of a goal: a time `within` (s) that a move of this hold does not have could never be kept.
std::vector<ValueFault> longer_than_the_move(double within, const study::ValueLimits& hold);

/// The first inconsistency between the values of a design point that is an error, "path: what; expected …";
/// empty if there is none.
std::string first_fault(const study::StudyPlan& plan, std::size_t point);

/// Why a study with these values at the edited point cannot be simulated: the first value out of its range,
/// or first_fault(); empty if it can.
std::string refusal_of(const study::PointEdit& edit);

}  // namespace zerocount::rules

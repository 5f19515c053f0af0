#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/machine/monitor/parameter_change.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::result_commands {

/// A parameter of a study that may have changed in a machine in use and so explain an alarm.
struct Cause {
  std::string name;  ///< Dotted path of the parameter.
  std::string unit{};
  monitor::ChangeKind kind{monitor::ChangeKind::factor};
  /// Changes that are simulated, in ascending order: factors or amounts. "No change" is one of them.
  std::vector<double> changes{};
  /// Function that adds an amount to the drawn parameters of a trial. Empty if the change is a factor on the
  /// study's value.
  std::function<void(trial::TrialParameters& parameters, double amount)> add{};
};

/// Parameters that may change in a machine in use at this design point. They are the real numbers of plant,
/// friction, encoder, converter, amplifier, control and disturbances that have an effect and are not 0,
/// "none" or a profile. Each is multiplied by factors between 0.35 and 2.8. An amount is added to some
/// parameters that are 0 or "none": encoder noise, delay, dead bands, the gap of a coupling, constant torques
/// and the converter's gain error.
///
/// The length of a count, the phase of a period and rates of aging are excluded, because use does not change
/// them.
std::vector<Cause> causes_of(const study::Study& study, std::int64_t point);

/// Copy of the study in which the parameter of `cause` is multiplied by `factor`; nothing if a value would be
/// impossible.
std::optional<study::Study> study_with_factor(const study::Study& study, std::int64_t point,
                                              const Cause& cause, double factor);

/// Splits comma-separated lists of parameters that cannot have changed into names. A name is a dotted path
/// from which parts in the middle or at the end may be left out, such as `controller.kp`, `encoder.noise` or
/// `controller`.
/// @throws Failure (bad_input) if a name matches no parameter that can change in some machine
std::vector<std::string> unchanged_names(const study::Study& study, const std::vector<std::string>& lists);

/// Whether a dotted path matches a name from which parts may be left out: the path begins with the first part
/// of the name, and contains the other parts in the same order.
bool is_named(std::string_view path, std::string_view name);

}  // namespace zerocount::result_commands

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/monitor/parameter_change.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::result_commands {

/// A parameter of a study that may have changed in a machine.
struct Cause {
  std::string name;  ///< dotted path
  std::string unit{};
  monitor::ChangeKind kind{monitor::ChangeKind::factor};
  std::vector<double> changes{};  ///< rising, with the one of no change among them
  /// Adds an amount to the drawn parameters of a trial. Empty for a factor, which scales the study's value.
  std::function<void(trial::TrialParameters& parameters, double amount)> add{};
};

/// The parameters that may change in a machine at this point: each real number of plant, friction, encoder,
/// converter, amplifier, control and disturbances that has an effect and is not 0, "none" or a profile. It is
/// multiplied by factors between 0.35 and 2.8. To some that are 0 or "none" an amount is added: encoder
/// noise, delay, dead bands, the gap of a coupling, constant torques and the converter's gain error.
///
/// The length of a count, the phase of a period and rates of aging are none of them: a machine that is used
/// does not change them.
std::vector<Cause> causes_of(const study::Study& study, std::int64_t point);

/// The study with the parameter multiplied; nothing where a value would be impossible.
std::optional<study::Study> study_with_factor(const study::Study& study, std::int64_t point,
                                              const Cause& cause, double factor);

/// The names in comma-separated lists of parameters that cannot have changed: dotted paths, from which parts
/// in the middle or at the end may be left out, such as `controller.kp`, `encoder.noise` or `controller`.
/// @throws Failure (bad_input) if a name is not one of a parameter that can change in some machine
std::vector<std::string> unchanged_names(const study::Study& study, const std::vector<std::string>& lists);

/// Whether the dotted path is what is named: it begins with the first part of the name, and has the others in
/// their order.
bool is_named(std::string_view path, std::string_view name);

}  // namespace zerocount::result_commands

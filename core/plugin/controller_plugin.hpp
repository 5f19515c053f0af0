#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <zerocount/controller.h>

namespace zerocount::plugin {

/// A parameter of a user's controller.
struct PluginParameter {
  std::string name;
  std::string unit;
  std::string meaning;
  double default_value{0.0};
  double lowest{0.0};   ///< Lowest value allowed; may be infinite
  double highest{0.0};  ///< Highest value allowed; may be infinite
};

/// Description of a user's controller. A study has it even if the library is not loaded.
struct PluginDescription {
  std::string name;
  std::string version;
  std::string sha256;  ///< SHA-256 checksum of the library's bytes
  std::vector<PluginParameter> parameters;
};

/// The torque (N m) that a control law wants at a sample; not finite if it cannot go on.
using StepFunction = std::function<double(const zerocount_sample&)>;

/// A user's controller.
struct ControllerPlugin {
  PluginDescription description;
  /// Null if the library is not loaded: then no trial can be run, unless there is `start`.
  const zerocount_controller* functions{nullptr};
  /// A control law of this process in place of a library. It is called before the first sample of each trial,
  /// and the function that it returns is called at each sample. Either may throw, which ends the trial by
  /// that exception.
  std::function<StepFunction(const zerocount_setup&)> start{};
};

/// Why a library's description cannot be used.
struct PluginFault {
  std::string what;
  std::string expected;
};

inline constexpr std::size_t max_plugin_parameters = 128;
/// Largest size of a plugin's state, bytes
inline constexpr std::size_t max_plugin_state = std::size_t{1} << 20;

/// Checks the description that zerocount_controller_entry() returned. @param sha256 checksum of the library.
std::variant<ControllerPlugin, PluginFault> checked_plugin(const zerocount_controller* entry,
                                                           std::string sha256);

}  // namespace zerocount::plugin

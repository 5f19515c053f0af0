#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <zerocount/controller.h>

namespace zerocount::plugin {

/// Description of one parameter of a user's controller plugin.
struct PluginParameter {
  std::string name;
  std::string unit;
  std::string meaning;
  double default_value{0.0};
  double lowest{0.0};   ///< Lowest value of the parameter allowed; may be infinite
  double highest{0.0};  ///< Highest value of the parameter allowed; may be infinite
};

/// Description of a user's controller plugin. A study has it even if the plugin's library is not loaded.
struct PluginDescription {
  std::string name;
  std::string version;
  std::string sha256;  ///< SHA-256 checksum of the library's bytes
  std::vector<PluginParameter> parameters;
};

/// Function that computes the torque (N m) which a control law wants at a sample; not finite if it cannot go
/// on.
using StepFunction = std::function<double(const zerocount_sample&)>;

/// A user's controller: a loaded library, or functions of this process.
struct ControllerPlugin {
  PluginDescription description;
  /// Functions of the loaded library. Null if no library is loaded: then no trial can be run, unless there is
  /// `start`.
  const zerocount_controller* functions{nullptr};
  /// A control law of this process in place of a library. It is called before the first sample of each trial,
  /// and the function that it returns is called at each sample. Either may throw, which ends the trial by
  /// that exception.
  std::function<StepFunction(const zerocount_setup&)> start{};
};

/// Reason why the description of a plugin's library cannot be used.
struct PluginFault {
  std::string what;
  std::string expected;
};

inline constexpr std::size_t max_plugin_parameters = 128;
/// Largest memory that a plugin may request for its state in one trial, bytes
inline constexpr std::size_t max_plugin_state = std::size_t{1} << 20;

/// Checks the description that the library's function zerocount_controller_entry() returned.
/// @param sha256 SHA-256 checksum of the library file.
/// @returns the plugin, or the reason why it cannot be used.
std::variant<ControllerPlugin, PluginFault> checked_plugin(const zerocount_controller* entry,
                                                           std::string sha256);

}  // namespace zerocount::plugin

#include "core/plugin/controller_plugin.hpp"

#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/text/text.hpp"

namespace zerocount::plugin {
namespace {

using Fault = std::optional<PluginFault>;

bool is_text(const char* text) {
  return text != nullptr && *text != '\0' && text::is_printable(text);
}

bool is_name(std::string_view text) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz";
  return !text.empty() && letters.find(text.front()) != std::string_view::npos &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

Fault fault_of_layout(const zerocount_controller& entry) {
  // The two numbers stand first in every version.
  if (entry.abi_version != ZEROCOUNT_CONTROLLER_ABI) {
    return PluginFault{
        fmt::format("it is made for version {} of zerocount/controller.h", entry.abi_version),
        fmt::format("version {}: compile it with the header of this zerocount", ZEROCOUNT_CONTROLLER_ABI)};
  }
  if (entry.size != sizeof(zerocount_controller)) {
    return PluginFault{fmt::format("its zerocount_controller has {} bytes", entry.size),
                       fmt::format("size = sizeof(zerocount_controller), {}", sizeof(zerocount_controller))};
  }
  return std::nullopt;
}

Fault fault_of_controller(const zerocount_controller& entry) {
  const std::string expected = "a text in UTF-8, without control characters, in zerocount_controller.";
  if (!is_text(entry.name)) return PluginFault{"it has no name", expected + "name"};
  if (!is_text(entry.version)) return PluginFault{"it has no version", expected + "version"};
  if (entry.start == nullptr || entry.step == nullptr)
    return PluginFault{"it lacks a function", "start and step in zerocount_controller"};
  if (entry.state_size > max_plugin_state) {
    return PluginFault{fmt::format("its state has {} bytes", entry.state_size),
                       fmt::format("at most {} bytes", max_plugin_state)};
  }
  if (entry.parameter_count > max_plugin_parameters) {
    return PluginFault{fmt::format("it has {} parameters", entry.parameter_count),
                       fmt::format("at most {}", max_plugin_parameters)};
  }
  if (entry.parameter_count > 0 && entry.parameters == nullptr)
    return PluginFault{"its list of parameters is missing", "zerocount_controller.parameters"};
  return std::nullopt;
}

Fault fault_of_parameter(const zerocount_parameter& p, std::size_t index) {
  if (p.name == nullptr || !is_name(p.name)) {
    return PluginFault{fmt::format("the name of its parameter {} is '{}'", index, p.name ? p.name : ""),
                       "lower-case letters, digits and _, a letter first"};
  }
  if (!is_text(p.unit) || !is_text(p.meaning))
    return PluginFault{fmt::format("its parameter {} lacks a unit or a meaning", p.name),
                       "both, as texts in UTF-8, without control characters"};
  if (!(p.lowest <= p.highest)) {
    return PluginFault{
        fmt::format("the range of its parameter {} is from {} to {}", p.name, p.lowest, p.highest),
        "lowest at most highest"};
  }
  const bool inside =
      std::isfinite(p.default_value) && p.default_value >= p.lowest && p.default_value <= p.highest;
  if (!inside) {
    return PluginFault{fmt::format("the default of its parameter {} is {}", p.name, p.default_value),
                       fmt::format("a number from {} to {}", p.lowest, p.highest)};
  }
  return std::nullopt;
}

}  // namespace

std::variant<ControllerPlugin, PluginFault> checked_plugin(const zerocount_controller* entry,
                                                           std::string sha256) {
  if (entry == nullptr) return PluginFault{"zerocount_controller_entry() returned nothing", "a controller"};
  if (const Fault fault = fault_of_layout(*entry)) return *fault;
  if (const Fault fault = fault_of_controller(*entry)) return *fault;
  ControllerPlugin plugin{{entry->name, entry->version, std::move(sha256), {}}, entry};
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < entry->parameter_count; ++i) {
    const zerocount_parameter& p = entry->parameters[i];
    if (const Fault fault = fault_of_parameter(p, i)) return *fault;
    if (!names.insert(p.name).second)
      return PluginFault{fmt::format("two of its parameters have the name {}", p.name), "different names"};
    plugin.description.parameters.push_back(
        {p.name, p.unit, p.meaning, p.default_value, p.lowest, p.highest});
  }
  return plugin;
}

}  // namespace zerocount::plugin

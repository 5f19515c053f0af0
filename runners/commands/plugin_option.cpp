#include "runners/commands/plugin_option.hpp"

#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "runners/plugins/plugin_library.hpp"

namespace zerocount::commands {

std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments) {
  const std::optional<std::string> path = arguments.value("plugin");
  if (!path) return nullptr;
  const sections::LoadedPlugin loaded = plugins::load_plugin(*path);
  if (const auto* fault = std::get_if<plugin::PluginFault>(&loaded))
    arguments.refuse(fmt::format("option '--plugin': {}; expected {}", fault->what, fault->expected));
  return std::get<std::shared_ptr<const plugin::ControllerPlugin>>(loaded);
}

}  // namespace zerocount::commands

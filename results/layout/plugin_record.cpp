#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/text/text.hpp"
#include "results/layout/header.hpp"

namespace zerocount::layout {
namespace {

using Json = nlohmann::ordered_json;

Json limit_as_json(double limit) {
  return std::isfinite(limit) ? Json(limit) : Json();
}

double limit_from_json(const Json& limit, double none) {
  return limit.is_null() ? none : limit.get<double>();
}

/// Whether all texts of the plugin's description are UTF-8 without control characters, so that they can stand
/// in messages and tables.
bool is_printable(const plugin::PluginDescription& plugin) {
  const auto printable = [](const plugin::PluginParameter& p) {
    return text::is_printable(p.name) && text::is_printable(p.unit) && text::is_printable(p.meaning);
  };
  return text::is_printable(plugin.name) && text::is_printable(plugin.version) &&
         text::is_printable(plugin.sha256) &&
         std::all_of(plugin.parameters.begin(), plugin.parameters.end(), printable);
}

}  // namespace

std::string plugin_as_json(const plugin::PluginDescription& plugin) {
  Json parameters = Json::array();
  for (const plugin::PluginParameter& p : plugin.parameters) {
    parameters.push_back({{"name", p.name},
                          {"unit", p.unit},
                          {"meaning", p.meaning},
                          {"default", p.default_value},
                          {"lowest", limit_as_json(p.lowest)},
                          {"highest", limit_as_json(p.highest)}});
  }
  return Json{{"name", plugin.name},
              {"version", plugin.version},
              {"sha256", plugin.sha256},
              {"parameters", std::move(parameters)}}
      .dump();
}

std::optional<plugin::PluginDescription> plugin_from_json(const std::string& text) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  try {
    const Json json = Json::parse(text);
    plugin::PluginDescription plugin{json.at("name").get<std::string>(),
                                     json.at("version").get<std::string>(),
                                     json.at("sha256").get<std::string>(),
                                     {}};
    for (const Json& p : json.at("parameters")) {
      plugin.parameters.push_back({p.at("name").get<std::string>(), p.at("unit").get<std::string>(),
                                   p.at("meaning").get<std::string>(), p.at("default").get<double>(),
                                   limit_from_json(p.at("lowest"), -unlimited),
                                   limit_from_json(p.at("highest"), unlimited)});
    }
    if (plugin.parameters.size() > plugin::max_plugin_parameters || !is_printable(plugin))
      return std::nullopt;
    return plugin;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace zerocount::layout

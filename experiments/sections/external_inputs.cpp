#include "experiments/sections/external_inputs.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::sections {

PluginLoader known_plugin(std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  return [plugin = std::move(plugin)](const std::string&) -> LoadedPlugin {
    if (plugin) return plugin;
    return plugin::PluginFault{"the controller plugin is not known here", "a file that describes it"};
  };
}

void read_plugin(const yaml::Field& root, const PluginLoader& load, keys::StudyDraft& draft) {
  const auto controller = yaml::find_field(root, "controller");
  const auto field = controller ? yaml::find_field(*controller, "plugin") : std::nullopt;
  if (!field || !shapes::read(*field, keys::shape_of("controller.plugin"), draft.problems)) return;
  if (!load) {
    draft.problems.add(*field, "this command does not load plugins", "the command check, run or trace");
    return;
  }
  const LoadedPlugin loaded = load(field->node->text);
  if (const auto* fault = std::get_if<plugin::PluginFault>(&loaded)) {
    draft.problems.add(*field, fault->what, fault->expected);
    draft.plugin_failed = true;
  } else {
    draft.plan.plugin = std::get<std::shared_ptr<const plugin::ControllerPlugin>>(loaded);
  }
}

ExternalInputs known_external_inputs(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                                     std::optional<std::string> samples) {
  return {.plugin = known_plugin(std::move(plugin)),
          .samples = [samples = std::move(samples)](const std::string& path, std::string_view) {
            if (samples) return *samples;
            throw Failure(ExitCode::bad_data,
                          fmt::format("{}: this table of samples was not recorded", path));
          }};
}

ExternalInputs external_inputs_of(const study::Study& study) {
  std::optional<std::string> samples;
  if (study.samples) samples = study.samples->text;
  ExternalInputs external = known_external_inputs(study.plugin, std::move(samples));
  external.rotors = study.plan->profiles;
  return external;
}

}  // namespace zerocount::sections

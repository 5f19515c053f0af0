// Feeds what a user's controller says of itself: the description that its library returns and the message
// with which it refuses to start, or the record of the description in a results file.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include <fuzzer/FuzzedDataProvider.h>

#include "core/plugin/controller_plugin.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/study_use.hpp"

namespace {

using namespace zerocount;

/// The message that the plugin's controller returns when it starts. It is global because the C function has
/// no argument to pass it.
std::string& message_of_start() {
  static std::string message;
  return message;
}

int start(void*, const zerocount_setup*, char* message, std::size_t size) {
  const std::string& text = message_of_start();
  std::memcpy(message, text.data(), std::min(size, text.size()));
  return text.empty() ? 0 : 1;
}

double step(void*, const zerocount_setup*, const zerocount_sample* sample) {
  return 1e-4 * sample->error;
}

/// A plugin's description made from fuzzer input, with the memory that its pointers refer to.
struct Description {
  std::list<std::string> texts;
  std::vector<zerocount_parameter> parameters;
  zerocount_controller controller{};
};

/// A text from the fuzzer's input up to a byte 0; often the valid text `usual`, rarely a null pointer.
const char* text_from(FuzzedDataProvider& input, std::list<std::string>& texts, const char* usual) {
  const int form = input.ConsumeIntegralInRange(0, 15);
  if (form == 0) return nullptr;
  if (form < 8) return usual;
  return texts.emplace_back(input.ConsumeRandomLengthString(64)).c_str();
}

double number_from(FuzzedDataProvider& input, double usual) {
  constexpr double special[] = {std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(), 0.0};
  const int form = input.ConsumeIntegralInRange(0, 7);
  if (form < 4) return usual;
  return form == 4 ? input.PickValueInArray(special) : input.ConsumeFloatingPoint<double>();
}

/// Fills a plugin description from the fuzzer's input. The number of parameters may exceed the allowed
/// maximum, but not the length of the list: the program could not notice that.
void describe(FuzzedDataProvider& input, Description& made) {
  constexpr const char* usual_names[] = {"kp", "ki", "gain", "limit_2"};
  const auto count = input.ConsumeIntegralInRange<std::size_t>(0, 4);
  for (std::size_t i = 0; i < count; ++i) {
    made.parameters.push_back({text_from(input, made.texts, usual_names[i]),
                               text_from(input, made.texts, "N m"), text_from(input, made.texts, "meaning"),
                               number_from(input, 0.0), number_from(input, -1.0), number_from(input, 1.0)});
  }
  zerocount_controller& c = made.controller;
  c.size = input.ConsumeBool() ? sizeof c : input.ConsumeIntegral<std::uint32_t>();
  c.abi_version = input.ConsumeBool() ? ZEROCOUNT_CONTROLLER_ABI : input.ConsumeIntegral<std::uint32_t>();
  c.name = text_from(input, made.texts, "own");
  c.version = text_from(input, made.texts, "1");
  c.parameters = made.parameters.data();
  c.parameter_count = static_cast<std::uint32_t>(count);
  if (input.ConsumeIntegralInRange(0, 15) == 0) c.parameter_count = plugin::max_plugin_parameters + 1;
  c.state_size = input.ConsumeBool() ? 64 : input.ConsumeIntegral<std::uint32_t>();
  c.start = input.ConsumeIntegralInRange(0, 15) == 0 ? nullptr : start;
  c.step = input.ConsumeIntegralInRange(0, 15) == 0 ? nullptr : step;
}

sections::LoadedPlugin load(const Description& made) {
  auto checked = plugin::checked_plugin(&made.controller, std::string(64, '0'));
  if (auto* fault = std::get_if<plugin::PluginFault>(&checked)) return *fault;
  return std::make_shared<const plugin::ControllerPlugin>(
      std::move(std::get<plugin::ControllerPlugin>(checked)));
}

study::Study study_with(const sections::PluginLoader& loader, const std::string& parameters) {
  return manifest::parse_study(
      "zerocount: 1\nname: own\nseed: 1\ntrials: 1\ncommand: {targets: [1], hold: 0.1}\ncontroller: {plugin: "
      "own.so" +
          parameters + "}\n",
      "study.yaml", {}, {.plugin = loader});
}

/// Uses a study with the plugin's controller: its parameters, its listing, its record, and the start of a
/// trial.
void use_controller(const Description& made, const std::string& parameters) {
  const study::Study study = study_with([&](const std::string&) { return load(made); }, parameters);
  fuzz::use_study(study);
  const std::string record = layout::plugin_as_json(study.plugin->description);
  if (!layout::plugin_from_json(record)) throw std::logic_error("its record cannot be read: " + record);
  trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  trial.command.hold = 0.002;
  trial.verdict.dwell = trial.verdict.window = 1.0 / trial.controller.sample_rate;
  trial::run_trial(trial);
}

void use_record(const std::string& text) {
  const std::optional<plugin::PluginDescription> description = layout::plugin_from_json(text);
  if (!description) return;
  const auto plugin =
      std::make_shared<const plugin::ControllerPlugin>(plugin::ControllerPlugin{*description});
  fuzz::use_study(study_with([&](const std::string&) { return plugin; }, ""));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  if (input.ConsumeIntegralInRange(0, 3) == 0) {
    const std::string record = input.ConsumeRemainingBytesAsString();
    fuzz::require_clear_refusal([&] { use_record(record); });
    return 0;
  }
  Description made;
  describe(input, made);
  message_of_start() = input.ConsumeRandomLengthString(600);
  const std::string parameters = input.ConsumeBool() ? "" : ", parameters: {kp: 0.5}";
  fuzz::require_clear_refusal([&] { use_controller(made, parameters); });
  return 0;
}

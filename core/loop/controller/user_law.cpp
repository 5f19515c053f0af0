#include "core/loop/controller/user_law.hpp"

#include <array>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/plugin/arithmetic_mode.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "core/text/text.hpp"

namespace zerocount::loop {
namespace {

constexpr std::align_val_t state_alignment{64};

/// Deleter for the state that a plugin keeps for one trial.
struct FreeState {
  void operator()(std::byte* bytes) const { ::operator delete(bytes, state_alignment); }
};
using State = std::unique_ptr<std::byte, FreeState>;

State make_state(std::size_t size) {
  State bytes(static_cast<std::byte*>(::operator new(size, state_alignment)));
  std::memset(bytes.get(), 0, size);
  return bytes;
}

/// Starts the controller of a loaded library for one trial.
/// @param setup must outlive the result.
/// @returns the function that computes the torque at a sample.
/// @throws Failure (bad_input) if the library refuses its parameters.
plugin::StepFunction started(const plugin::ControllerPlugin& plugin, const zerocount_setup& setup) {
  const zerocount_controller& functions = *plugin.functions;
  std::shared_ptr<std::byte> state = make_state(functions.state_size);
  std::array<char, 512> message{};
  if (functions.start(state.get(), &setup, message.data(), message.size()) == 0) {
    return [state = std::move(state), &setup, step = functions.step](const zerocount_sample& sample) {
      return step(state.get(), &setup, &sample);
    };
  }
  message.back() = '\0';
  throw Failure(
      ExitCode::bad_input,
      fmt::format("the controller {} cannot start: {}", plugin.description.name,
                  message[0] != '\0' ? text::printable_lines(message.data()) : "it does not say why"));
}

}  // namespace

struct UserLaw::Running {
  std::shared_ptr<const plugin::ControllerPlugin> plugin;
  std::vector<double> parameters;
  zerocount_setup setup{};
  plugin::StepFunction step{};
  plugin::ArithmeticMode mode{};
  std::int64_t k{0};
};

UserLaw::UserLaw(const ControllerParameters& p, const ControlStart& start)
    : running_(std::make_unique<Running>(Running{p.user.plugin, p.user.parameters})) {
  Running& running = *running_;
  const plugin::ControllerPlugin& plugin = *running.plugin;
  running.setup = {.size = sizeof(zerocount_setup),
                   .parameter_count = static_cast<std::uint32_t>(running.parameters.size()),
                   .parameters = running.parameters.data(),
                   .sample_time = 1.0 / p.sample_rate,
                   .resolution = start.resolution,
                   .torque_resolution = start.dac.resolution,
                   .lowest_torque = start.dac.range.lowest,
                   .highest_torque = start.dac.range.highest,
                   .initial_integral = start.integral,
                   .other_resolution = start.other_resolution};
  if (plugin.start) {
    running.step = plugin.start(running.setup);
  } else if (plugin.functions != nullptr) {
    running.step = started(plugin, running.setup);
  } else {
    throw Failure(
        ExitCode::bad_input,
        fmt::format(
            "the controller is the plugin {}, which is not loaded: plugins are loaded only from a path "
            "that is given to the command",
            plugin.description.name));
  }
  running.mode.restore();
}

UserLaw::UserLaw(UserLaw&&) noexcept = default;
UserLaw& UserLaw::operator=(UserLaw&&) noexcept = default;
UserLaw::~UserLaw() = default;

double UserLaw::step(const Feedback& now, double /*torque*/) {
  Running& running = *running_;
  const zerocount_sample sample{.k = running.k,
                                .time = static_cast<double>(running.k) * running.setup.sample_time,
                                .error = now.error,
                                .count = now.count,
                                .reference = now.reference.position,
                                .torque = now.torque_in_force,
                                .velocity = now.reference.velocity,
                                .acceleration = now.reference.acceleration,
                                .new_target = now.new_target ? 1 : 0,
                                .other_count = now.other_count};
  ++running.k;
  const double torque = running.step(sample);
  running.mode.restore();
  return torque;
}

}  // namespace zerocount::loop

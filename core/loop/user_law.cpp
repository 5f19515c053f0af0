#include "core/loop/user_law.hpp"

#include <array>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/plugin/arithmetic_mode.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "core/text/utf8.hpp"

namespace zerocount::loop {
namespace {

constexpr std::align_val_t state_alignment{64};

}  // namespace

struct UserLaw::Running {
  struct FreeState {
    void operator()(std::byte* bytes) const { ::operator delete(bytes, state_alignment); }
  };
  using State = std::unique_ptr<std::byte, FreeState>;

  static State make_state(std::size_t size) {
    State bytes(static_cast<std::byte*>(::operator new(size, state_alignment)));
    std::memset(bytes.get(), 0, size);
    return bytes;
  }

  std::shared_ptr<const plugin::ControllerPlugin> plugin;
  double (*step)(void*, const zerocount_setup*, const zerocount_sample*);
  std::vector<double> parameters;
  zerocount_setup setup;
  State state;
  plugin::ArithmeticMode mode{};
  std::int64_t k{0};
};

UserLaw::UserLaw(const ControllerParameters& p, const ControlStart& start) {
  const plugin::ControllerPlugin& plugin = *p.user.plugin;
  if (plugin.functions == nullptr) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format(
            "the controller is the plugin {}, which is not loaded: plugins are loaded only from a path "
            "that is given to the command",
            plugin.description.name));
  }
  running_ = std::make_unique<Running>(Running{p.user.plugin,
                                               plugin.functions->step,
                                               p.user.parameters,
                                               {},
                                               Running::make_state(plugin.functions->state_size)});
  Running& running = *running_;
  running.setup = {.size = sizeof(zerocount_setup),
                   .parameter_count = static_cast<std::uint32_t>(running.parameters.size()),
                   .parameters = running.parameters.data(),
                   .sample_time = 1.0 / p.sample_rate,
                   .resolution = start.resolution,
                   .torque_resolution = start.dac.resolution,
                   .lowest_torque = start.dac.range.lowest,
                   .highest_torque = start.dac.range.highest,
                   .initial_integral = start.integral};
  std::array<char, 512> message{};
  const int refused =
      plugin.functions->start(running.state.get(), &running.setup, message.data(), message.size());
  running.mode.restore();
  if (refused == 0) return;
  message.back() = '\0';
  throw Failure(
      ExitCode::bad_input,
      fmt::format("the controller {} cannot start: {}", plugin.description.name,
                  message[0] != '\0' ? text::printable_lines(message.data()) : "it does not say why"));
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
                                .new_target = now.new_target ? 1 : 0};
  ++running.k;
  const double torque = running.step(running.state.get(), &running.setup, &sample);
  running.mode.restore();
  return torque;
}

}  // namespace zerocount::loop

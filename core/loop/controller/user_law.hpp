#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/loop/controller/control_block.hpp"

namespace zerocount::loop {

/// A control law of the user's own (ControllerParameters::user): a plugin by the interface in
/// zerocount/controller.h. It has no phases, and its transfer function is unknown.
class UserLaw {
 public:
  /// Starts the plugin's control law.
  /// @throws Failure (bad_input) if the plugin is not loaded, or refuses its parameters.
  UserLaw(const ControllerParameters& parameters, const ControlStart& start);
  UserLaw(UserLaw&&) noexcept;
  UserLaw& operator=(UserLaw&&) noexcept;
  ~UserLaw();

  /// The torque that the plugin wants at this sample, N m; not finite if the plugin fails.
  double step(const Feedback& now, double torque);
  void observe(const Feedback&) {}
  void pause(const Feedback&) {}
  double take_over(double /*torque*/) { return 0.0; }
  LinearChain linear() const { return {}; }
  double integral() const { return 0.0; }

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace zerocount::loop

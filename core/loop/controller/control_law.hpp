#pragma once

#include <variant>

#include "core/loop/controller/cascade.hpp"
#include "core/loop/controller/pid.hpp"
#include "core/loop/controller/user_law.hpp"

namespace zerocount::loop {

/// The control law, the first block of the controller: the PID law or the cascade, depending on
/// ControlBlocks::structure, or the user's own law.
class ControlLaw {
 public:
  ControlLaw(const ControllerParameters& parameters, const ControlStart& start)
      : law_(chosen(parameters, start)) {}

  double step(const Feedback& now, double torque) {
    return std::visit([&](auto& law) { return law.step(now, torque); }, law_);
  }
  void observe(const Feedback& now) {
    std::visit([&](auto& law) { law.observe(now); }, law_);
  }
  void pause(const Feedback& now) {
    std::visit([&](auto& law) { law.pause(now); }, law_);
  }
  double take_over(double torque) {
    return std::visit([&](auto& law) { return law.take_over(torque); }, law_);
  }
  LinearChain linear() const {
    return std::visit([](const auto& law) { return law.linear(); }, law_);
  }
  double integral() const {  ///< Integral I of the control law, N m
    return std::visit([](const auto& law) { return law.integral(); }, law_);
  }

 private:
  using Law = std::variant<Pid, Cascade, UserLaw>;

  static Law chosen(const ControllerParameters& parameters, const ControlStart& start) {
    if (parameters.user.plugin) return UserLaw(parameters, start);
    switch (parameters.blocks.structure) {
      case ControlStructure::cascade:
        return Cascade(parameters, start);
      case ControlStructure::pid:
        break;
    }
    return Pid(parameters, start);
  }

  Law law_;
};

}  // namespace zerocount::loop

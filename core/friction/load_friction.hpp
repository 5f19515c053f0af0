#pragma once

#include <optional>
#include <variant>

#include "core/friction/bristles/bristle.hpp"
#include "core/friction/parameters.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/friction/sliding/standing.hpp"
#include "core/motion/load.hpp"

namespace zerocount::friction {

enum class LoadFrictionModel { none, coulomb, dahl, lugre };

/// Friction between a second mass and the frame, by the law of that name without its viscous part. At t = 0
/// it is virgin: it carries no torque and has no history.
struct LoadFrictionParameters {
  LoadFrictionModel model{LoadFrictionModel::none};
  FrictionParameters contact{};
};

/// Coulomb friction on a second mass. The mass stands until the torque on it passes the breakaway torque, and
/// slides as described at Slide until its velocity ωL = 0. A torque at the breakaway level is treated as in
/// stand_step().
class CoulombOnLoad final : public motion::LoadFriction {
 public:
  CoulombOnLoad(const FrictionParameters& contact, double inertia, double velocity);

  void start(const motion::Load& load) override;
  double expand(const numerics::Series& omega, double torque, std::size_t k) override;
  double step_within(double tolerance, double duration) override;
  std::optional<double> next_event(const numerics::Series& omega, double step) override;
  void go_to(double time, bool at_event, motion::Load& load) override;

 private:
  Slide slide() const { return {contact_, 0.0, 0.0, omega_, direction_, at_level_}; }
  StandingRotor standing() const { return {{contact_.breakaway, inertia_, spent_}, vibration_}; }

  FrictionParameters contact_;
  double inertia_;
  double omega_;
  bool sliding_;
  double direction_;      // −1, 1
  bool at_level_{false};  // Slide::at_level
  bool spent_{false};     // StandingContact::spent
  double travel_{0.0};    // of the slide, rad
  double tolerance_{0.0};
  const motion::Disturbance* vibration_{nullptr};  // of this step
  SlidingSeries sliding_series_{};
  StandingSeries standing_series_{};
};

/// Friction on a second mass by the bristle law of Dahl or LuGre (BristleMotion), between the mass and the
/// frame.
class BristleOnLoad final : public motion::LoadFriction {
 public:
  BristleOnLoad(const BristleParameters& parameters, double inertia)
      : parameters_(parameters), inertia_(inertia) {}

  void start(const motion::Load& load) override;
  double expand(const numerics::Series& omega, double torque, std::size_t k) override;
  double step_within(double tolerance, double duration) override;
  std::optional<double> next_event(const numerics::Series& omega, double step) override;
  void go_to(double time, bool at_event, motion::Load& load) override;

 private:
  BristleMotion motion() { return {parameters_, direction_, saturated_, theta_, omega_, deflection_}; }

  BristleParameters parameters_;
  double inertia_;
  double theta_{0.0};
  double omega_{0.0};
  double deflection_{0.0};
  double direction_{1.0};  // the sign of ωL from now on
  bool saturated_{false};
  BristleMotion::Event next_{BristleMotion::Event::none};
  BristleSeries series_{};
};

using FrictionOfLoad = std::variant<std::monostate, CoulombOnLoad, BristleOnLoad>;

/// Pointer to the friction of a second mass as its interface LoadFriction; null without friction.
inline motion::LoadFriction* to_load_friction(FrictionOfLoad& friction) {
  if (auto* const coulomb = std::get_if<CoulombOnLoad>(&friction)) return coulomb;
  return std::get_if<BristleOnLoad>(&friction);
}

/// Creates the friction of a second mass in its initial state.
/// @param inertia inertia JL of the mass, kg m².
/// @param velocity velocity ωL of the mass at the start, rad/s.
FrictionOfLoad friction_of_load(const LoadFrictionParameters& friction, double inertia, double velocity);

}  // namespace zerocount::friction

#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "core/friction/laws.hpp"
#include "core/friction/load_friction.hpp"
#include "core/motion/load.hpp"

namespace zerocount::plant {

/// Largest number of integration steps in one call of advance(), whatever its duration. If more are
/// needed, the motion counts as lost.
inline constexpr int max_steps = 200000;
/// Largest number of integration steps in one sample of a trial. A ringing trial of the paper's machine needs
/// about three; a trial with ten thousand in each sample would run for hours.
inline constexpr int max_steps_of_sample = 10000;

/// The plant: a rotor with a friction law, and a second mass if there is one, under a motor's torque.
template <friction::FrictionLaw Law>
class PlantWith : public Law {
 public:
  PlantWith(const motion::PlantParameters& plant, const friction::FrictionAlongRotor& friction,
            const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : Law(plant, friction, start, tolerance), inertia_(plant.inertia), tolerance_(tolerance.elongation) {
    if (motion::has_load(plant)) load_ = motion::Load{plant.load, 0.0, start.velocity};
  }

  /// Adds a disturbance torque on the rotor from now on; its vibrations start at t = 0 now.
  void disturb(const motion::Disturbance& disturbance) {
    disturbance_ = disturbance;
    time_ = 0.0;
  }
  /// Adds disturbance, kinematic error and friction to the second mass, if there is one, from now on; its
  /// vibrations start at t = 0 now.
  void start_load(const motion::LoadSide& side, const friction::LoadFrictionParameters& friction = {}) {
    if (!load_) return;
    load_friction_ = friction::friction_of_load(friction, load_->parameters.inertia, load_->omega);
    load_->error = side.error;
    load_->disturbance = side.disturbance;
    load_->twist = side.twist;
  }
  /// Sets the time t (s) of the disturbances exactly; advance() adds durations and so accumulates rounding
  /// errors.
  void set_time(double time) { time_ = time; }

  /// Moves the plant under the torque for `duration` (s). The motion is lost if that takes more than
  /// `step_limit` integration steps.
  void advance(const motion::TorqueCourse& torque, double duration, int step_limit = max_steps) {
    motion::TorqueCourse ahead = torque;
    ahead.now += disturbance_.torque;
    ahead.settled += disturbance_.torque;
    ahead.load = load_ ? &*load_ : nullptr;
    if (load_) load_->friction = friction::to_load_friction(load_friction_);
    motion::VaryingTorque varying{disturbance_, time_, 0.0};
    if (motion::varies(disturbance_)) ahead.disturbance = &varying;
    bool moves = !motion::motor_is_constant(ahead);
    double remaining = duration;
    for (int step = 0; remaining > 0.0 && finite_; ++step) {
      if (step == step_limit) finite_ = false;
      ++steps_;
      varying.theta = this->theta();
      if (load_) {
        load_->rotor_theta = varying.theta;
        load_->time = varying.time;
      }
      const double used = step_on(ahead, remaining);
      varying.time += used;
      remaining = used < remaining ? remaining - used : 0.0;
      if (moves) {
        moves = duration - remaining < motion::time_to_settle(ahead);
        ahead = moves
                    ? motion::course_after(ahead, used)
                    : motion::TorqueCourse{ahead.settled, ahead.settled, 0.0, ahead.load, ahead.disturbance};
      }
      finite_ = finite_ && std::isfinite(this->theta()) && std::isfinite(this->omega()) &&
                (!load_ || std::isfinite(load_->omega));
    }
    time_ += duration;
  }

  /// False once the motion is lost, because it is not finite or took too many steps; it stays false.
  bool finite() const { return finite_; }
  /// Number of integration steps since the start.
  std::int64_t steps() const { return steps_; }
  /// The second mass with its state; empty without one.
  const std::optional<motion::Load>& load() const { return load_; }
  std::optional<motion::Load>& load() { return load_; }

 private:
  /// Advances the plant by one integration step.
  /// @returns the time used, at most `duration` (s).
  double step_on(const motion::TorqueCourse& torque, double duration) {
    if constexpr (motion::SmoothMotion<Law>) {
      return motion::taylor_step<Law>(*this, inertia_, torque, tolerance_, duration).time;
    } else {
      return this->step(torque, duration);
    }
  }

  double inertia_;
  double tolerance_;
  bool finite_{true};
  std::int64_t steps_{0};
  std::optional<motion::Load> load_;
  friction::FrictionOfLoad load_friction_;
  motion::Disturbance disturbance_{};
  double time_{0.0};  // of the disturbances, s
};

/// State of the plant at an instant, as it is recorded.
struct PlantReading {
  double theta{0.0};  ///< Rotor angle θ, rad
  double omega{0.0};  ///< Rotor velocity ω, rad/s
  friction::CreepState
      creep{};  ///< Creep in the present friction contact or, while it slides, in the last one that stuck
  std::int64_t depth{0};  ///< Number of reversal points on the spring's stack
  bool sliding{false};
  double load_theta{0.0};  ///< Angle θL of the load, rad; θ without a load
  double load_omega{0.0};  ///< Velocity ωL of the load, rad/s; ω without a load
};

/// The plant of a trial, with the friction law that the manifest's key friction.model selects at run time.
template <class Laws>
class PlantOf {
 public:
  PlantOf(const motion::PlantParameters& plant, const friction::FrictionAlongRotor& friction,
          const motion::PlantStart& start, const motion::MotionTolerance& tolerance)
      : plant_(makers.at(static_cast<std::size_t>(friction.model))(plant, friction, start, tolerance)),
        breakaway_(Laws::traits.at(static_cast<std::size_t>(friction.model)).breakaway) {}

  /// Moves the plant under the torque for `duration` (s). The motion is lost if that takes more than
  /// `step_limit` integration steps.
  void advance(const motion::TorqueCourse& torque, double duration, int step_limit = max_steps) {
    std::visit([&](auto& plant) { plant.advance(torque, duration, step_limit); }, plant_);
  }

  /// Adds a disturbance torque on the rotor from now on; its vibrations start at t = 0 now.
  void disturb(const motion::Disturbance& disturbance) {
    std::visit([&](auto& plant) { plant.disturb(disturbance); }, plant_);
  }
  /// Adds disturbance, kinematic error and friction to the second mass, if there is one, from now on; its
  /// vibrations start at t = 0 now.
  void start_load(const motion::LoadSide& side, const friction::LoadFrictionParameters& friction = {}) {
    std::visit([&](auto& plant) { plant.start_load(side, friction); }, plant_);
  }
  /// Sets the time t (s) of the disturbances' vibrations.
  void set_time(double time) {
    std::visit([&](auto& plant) { plant.set_time(time); }, plant_);
  }

  PlantReading read() const {
    return std::visit(
        [](const auto& plant) {
          PlantReading reading{plant.theta(),   plant.omega(), plant.creep(), plant.depth(),
                               plant.sliding(), plant.theta(), plant.omega()};
          if (plant.load()) {
            reading.load_theta = motion::load_theta(*plant.load(), plant.theta());
            reading.load_omega = plant.load()->omega;
          }
          return reading;
        },
        plant_);
  }
  /// Rotor angle θ, rad.
  double theta() const {
    return std::visit([](const auto& plant) { return plant.theta(); }, plant_);
  }
  /// Rotor velocity ω, rad/s.
  double omega() const {
    return std::visit([](const auto& plant) { return plant.omega(); }, plant_);
  }
  bool sliding() const {
    return std::visit([](const auto& plant) { return plant.sliding(); }, plant_);
  }
  /// False once the motion is lost, because it is not finite or took too many steps; it stays false.
  bool finite() const {
    return std::visit([](const auto& plant) { return plant.finite(); }, plant_);
  }
  /// Number of integration steps since the start.
  std::int64_t steps() const {
    return std::visit([](const auto& plant) { return plant.steps(); }, plant_);
  }
  /// Manner in which the plant's friction law passes from rest to sliding.
  friction::Breakaway breakaway() const { return breakaway_; }
  /// Number of times since the start that the friction contact has broken away into a slide.
  std::int64_t breakaways() const {
    return std::visit([](const auto& plant) { return plant.breakaways(); }, plant_);
  }
  /// Largest number of reversal points on the spring's stack since the last forget_deepest().
  std::int64_t deepest() const {
    return std::visit([](const auto& plant) { return plant.deepest(); }, plant_);
  }
  void forget_deepest() {
    std::visit([](auto& plant) { plant.forget_deepest(); }, plant_);
  }

 private:
  using AnyPlant = typename Laws::template Variant<PlantWith>;

  template <std::size_t law>
  static AnyPlant plant_with(const motion::PlantParameters& plant,
                             const friction::FrictionAlongRotor& friction, const motion::PlantStart& start,
                             const motion::MotionTolerance& tolerance) {
    return AnyPlant(std::in_place_index<law>, plant, friction, start, tolerance);
  }

  static constexpr auto makers = []<std::size_t... law>(std::index_sequence<law...>) {
    return std::array{&plant_with<law>...};
  }
  (std::make_index_sequence<std::variant_size_v<AnyPlant>>{});

  AnyPlant plant_;
  friction::Breakaway breakaway_;
};

using Plant = PlantOf<friction::FrictionLaws>;

}  // namespace zerocount::plant

#pragma once

#include <array>

#include "core/friction/law.hpp"

namespace zerocount {

/// A friction law that only the tests know: a linear spring with viscous damping, F = k·θ + d·ω. It counts
/// the sign changes of ω, which are located in time.
class SpringDamper : public friction::WithoutCreepAndReversals {
 public:
  static constexpr std::string_view word = "spring_damper";
  static constexpr std::array<friction::ContactField, 1> contact_parameters{
      &friction::FrictionParameters::k1};  // k
  static constexpr bool has_presliding_motion = true;
  static constexpr bool has_presliding_damping = true;  // d
  static constexpr bool has_sliding_damping = false;
  static constexpr bool remembers_loading = false;
  static constexpr friction::Breakaway breakaway = friction::Breakaway::never;
  static friction::LinearContacts linear_contacts(const motion::PlantParameters& plant,
                                                  const friction::FrictionAlongRotor&,
                                                  const friction::FrictionParameters& contact) {
    return {{"at k", contact.k1, plant.presliding_damping}};
  }

  struct Expansion {
    numerics::Series position{};  // θ
    numerics::Series omega{};
    numerics::Series exponent{};
  };
  enum class Event { none, turn };

  SpringDamper(const motion::PlantParameters& plant, const friction::FrictionAlongRotor& friction,
               const motion::PlantStart& start, const motion::MotionTolerance&)
      : stiffness_(friction::friction_at(friction, start.position).k1),
        damping_(plant.presliding_damping),
        omega_(start.velocity) {}

  Expansion start() const {
    Expansion s;
    s.position[0] = theta_;
    s.omega[0] = omega_;
    return s;
  }
  double expand(Expansion& s, std::size_t k, double torque) const {
    s.position[k + 1] = s.omega[k] * numerics::reciprocal[k + 1];
    return torque - stiffness_ * s.position[k] - damping_ * s.omega[k];
  }
  motion::NextEvent<Event> first_event(const Expansion& s, double step) const {
    motion::NextEvent<Event> next{step};
    next.offer(motion::next_sign_change(s.omega, step), Event::turn);
    return next;
  }
  void go_to(const Expansion& s, const motion::NextEvent<Event>& next) {
    theta_ = numerics::value_at(s.position, next.time);
    omega_ = next.event == Event::turn ? 0.0 : numerics::value_at(s.omega, next.time);
    turns_ += next.event == Event::turn ? 1 : 0;
  }

  double theta() const { return theta_; }
  double omega() const { return omega_; }
  static bool sliding() { return false; }
  static std::int64_t breakaways() { return 0; }
  int turns() const { return turns_; }

 private:
  double stiffness_;
  double damping_;
  double theta_{0.0};
  double omega_;
  int turns_{0};
};

}  // namespace zerocount

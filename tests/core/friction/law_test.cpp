// A friction law that only this test knows: the plant integrates it through the interface of all laws.
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/plant/plant.hpp"

namespace zerocount {
namespace {

/// A linear spring with viscous damping: F = k·θ + d·ω. It counts where ω changes sign, located in time.
class SpringDamper : public WithoutSpring {
 public:
  static constexpr std::string_view word = "spring_damper";
  static constexpr std::array<ContactField, 1> contact_parameters{&FrictionParameters::k1};  // k
  static constexpr bool has_presliding_damping = true;                                       // d
  static constexpr bool runs_in_lanes = false;

  struct Expansion {
    Series position{};  // θ
    Series omega{};
    Series exponent{};
  };
  enum class Event { none, turn };

  SpringDamper(const PlantParameters& plant, const FrictionAlongRotor& friction, const PlantStart& start,
               const MotionTolerance&)
      : stiffness_(friction_at(friction, start.position).k1),
        damping_(plant.presliding_damping),
        omega_(start.velocity) {}

  Expansion start() const {
    Expansion s;
    s.position[0] = theta_;
    s.omega[0] = omega_;
    return s;
  }
  double expand(Expansion& s, std::size_t k, double torque) const {
    s.position[k + 1] = s.omega[k] * reciprocal[k + 1];
    return torque - stiffness_ * s.position[k] - damping_ * s.omega[k];
  }
  NextEvent<Event> first_event(const Expansion& s, double step) const {
    NextEvent<Event> next{step};
    next.offer(next_sign_change(s.omega, step), Event::turn);
    return next;
  }
  void go_to(const Expansion& s, const NextEvent<Event>& next) {
    theta_ = value_at(s.position, next.time);
    omega_ = next.event == Event::turn ? 0.0 : value_at(s.omega, next.time);
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

static_assert(SmoothMotion<SpringDamper> && FrictionLaw<SpringDamper>);

constexpr PlantParameters rotor{.inertia = 5.54e-4, .presliding_damping = 0.05};
constexpr MotionTolerance tolerance{4e-16, 4e-14};

/// θ of J·θ″ = u − k·θ − d·θ′ from θ = 0 and ω₀: U + e^(−γt)·(−U·cos νt + (ω₀ − γU)/ν·sin νt), U = u/k, γ =
/// d/2J, ν² = k/J − γ².
double closed_form(double torque, double velocity, double stiffness, double t) {
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double frequency = std::sqrt(stiffness / rotor.inertia - decay * decay);
  const double end = torque / stiffness;
  return end + std::exp(-decay * t) * (-end * std::cos(frequency * t) +
                                       (velocity - decay * end) / frequency * std::sin(frequency * t));
}

TEST(ALawOfTheTests, MovesByItsClosedForm) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  for (const double velocity : {0.0, 0.3, -2.0}) {
    PlantWith<SpringDamper> plant(rotor, friction, {.velocity = velocity}, tolerance);
    for (int k = 1; k <= 200; ++k) {
      plant.advance(constant_torque(0.02), 5e-4);
      const double exact = closed_form(0.02, velocity, 110.0, k * 5e-4);
      ASSERT_NEAR(plant.theta(), exact, 1e-13) << velocity << " " << k;
    }
    EXPECT_TRUE(plant.finite());
  }
}

TEST(ALawOfTheTests, HasItsEventsLocatedInTime) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  const double decay = rotor.presliding_damping / (2.0 * rotor.inertia);
  const double half_period = std::numbers::pi / std::sqrt(110.0 / rotor.inertia - decay * decay);
  PlantWith<SpringDamper> plant(rotor, friction, {}, tolerance);
  for (int turn = 1; turn <= 8; ++turn) {  // from rest, ω = 0 after every half period
    plant.advance(constant_torque(0.02), (turn == 1 ? 0.5 : 1.0) * half_period);
    EXPECT_EQ(plant.turns(), turn - 1);
  }
}

// A torque that moves comes to the law by its series.
TEST(ALawOfTheTests, FollowsATorqueThatSettles) {
  const FrictionAlongRotor friction{{.k1 = 110.0}, {}};
  PlantWith<SpringDamper> whole(rotor, friction, {}, tolerance);
  PlantWith<SpringDamper> pieces(rotor, friction, {}, tolerance);
  const TorqueCourse course{0.0, 0.03, 700.0};
  whole.advance(course, 0.1);
  for (int k = 0; k < 100; ++k) pieces.advance(course_after(course, k * 1e-3), 1e-3);
  EXPECT_NEAR(whole.theta(), pieces.theta(), 1e-13);
  EXPECT_NEAR(whole.theta(), 0.03 / 110.0, 0.03 / 110.0 * 0.05);
}

}  // namespace
}  // namespace zerocount

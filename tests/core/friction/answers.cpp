// How rotors with each friction law move under random torques, for an independent integrator to judge: JSON
// on standard output. The argument is the number of motions of each law.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/plant/plant.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

constexpr double count = 3.878509448876288e-06;  // rad
constexpr double sample_time = 5e-4;             // s
constexpr motion::MotionTolerance tolerance{1e-11 * count, 1e-8 * count};

class Answers {
 public:
  template <class Law>
  Json motion(friction::FrictionModel model, bool loaded, bool disturbed, bool wide) {
    motion::PlantParameters rotor{.inertia = power_of_ten(-3.7, -2.7),
                                  .presliding_damping = power_of_ten(-2.0, 0.0),
                                  .sliding_damping = power_of_ten(-3.0, -1.0)};
    if (loaded) rotor.load = {power_of_ten(-4.0, -2.5), power_of_ten(2.5, 4.5), power_of_ten(-3.0, -0.5)};
    friction::FrictionAlongRotor friction = contact(model);
    motion::PlantStart start = beginning(friction);
    const motion::Disturbance disturbance =
        disturbed ? disturbance_of(friction, start) : motion::Disturbance{};
    plant::PlantWith<Law> plant(rotor, friction, start, tolerance);
    plant.disturb(disturbance);
    motion::LoadSide side;
    friction::LoadFrictionParameters load_friction;
    if (loaded && wide) {
      load_friction.model = static_cast<friction::LoadFrictionModel>(random_() % 4);
      load_friction.contact = contact(model).uniform;
      load_friction.contact.breakaway *= 0.3;
      side = load_side(rotor.load, friction.uniform.breakaway);
      plant = plant::PlantWith<Law>(rotor, friction, start, tolerance);
      plant.disturb(disturbance);
      plant.start_load(side, load_friction);
    }
    Json samples = Json::array();
    motion::TorqueCourse course;
    const bool lags = random_() % 3 == 0;
    const double size = friction.uniform.breakaway * power_of_ten(-1.0, 0.5);
    for (int k = 0; k < 60; ++k) {
      // Held for some samples, so that it also comes to rest.
      if (k % 10 == 0) course.settled = uniform(-1.0, 1.0) * size;
      if (!lags) course.now = course.settled;
      course.rate = lags ? 2000.0 : 0.0;
      plant.advance(course, sample_time);
      samples.push_back({course.now, course.settled, course.rate, plant.theta(), plant.omega(),
                         plant.sliding(), plant.load() ? plant.load()->twist : 0.0, plant.creep().extension,
                         plant.creep().hardening});
      course = motion::course_after(course, sample_time);
    }
    const friction::FrictionParameters& p = friction.uniform;
    Json elements = Json::array();
    for (const friction::GmsElement& e : friction.gms_elements) elements.push_back({e.stiffness, e.weight});
    return {{"model", Law::word},
            {"inertia", rotor.inertia},
            {"presliding_damping", rotor.presliding_damping},
            {"sliding_damping", rotor.sliding_damping},
            {"breakaway", p.breakaway},
            {"coulomb_ratio", p.coulomb_ratio},
            {"stribeck_velocity", p.stribeck_velocity},
            {"sigma0", p.sigma0},
            {"sigma1", p.sigma1},
            {"attraction", p.gms_attraction},
            {"elements", elements},
            {"k1", p.k1},
            {"k2", p.k2},
            {"beta", p.beta},
            {"alpha", p.alpha},
            {"lambda", p.lambda},
            {"n", p.n},
            {"hardening", start.hardening},
            {"loads", loads_of(start)},
            {"load_inertia", rotor.load.inertia},
            {"load_stiffness", rotor.load.stiffness},
            {"load_damping", rotor.load.damping},
            {"load_gap", rotor.load.gap},
            {"load_twist", side.twist},
            {"load_friction", friction_json(load_friction)},
            {"load_error", waves_of({.ripple = side.error})["ripple"]},
            {"load_damping_to_ground", rotor.load.damping_to_ground},
            {"load_disturbance", waves_of(side.disturbance)},
            {"velocity", start.velocity},
            {"slides", start.sliding},
            {"sample_time", sample_time},
            {"disturbance", waves_of(disturbance)},
            {"holding", start.holding},
            {"samples", samples}};
  }

 private:
  static Json friction_json(const friction::LoadFrictionParameters& friction) {
    if (friction.model == friction::LoadFrictionModel::none) return nullptr;
    const friction::FrictionParameters& p = friction.contact;
    constexpr std::array names{"none", "coulomb", "dahl", "lugre"};
    return {{"model", names.at(static_cast<std::size_t>(friction.model))},
            {"breakaway", p.breakaway},
            {"coulomb_ratio", p.coulomb_ratio},
            {"stribeck_velocity", p.stribeck_velocity},
            {"sigma0", p.sigma0},
            {"sigma1", p.sigma1}};
  }

  /// Random parameters of the load: a gap, a kinematic error, a damper and a disturbance, each in some of the
  /// cases.
  motion::LoadSide load_side(motion::LoadParameters& load, double breakaway) {
    motion::LoadSide side;
    if (random_() % 3 != 0) {
      load.gap = power_of_ten(-5.5, -3.5);
      side.twist = load.gap * (random_() % 3 == 0 ? 0.5 : uniform(-0.5, 0.5));
    }
    for (std::uint64_t i = random_() % 3; i > 0; --i) {
      const double per_angle = power_of_ten(0.0, 3.0);
      side.error.push_back({power_of_ten(-3.0, -0.6) / per_angle, per_angle, uniform(0.0, 6.0)});
    }
    if (random_() % 2 == 0) load.damping_to_ground = power_of_ten(-4.0, -1.0);
    if (random_() % 2 == 0) {
      side.disturbance.torque = 0.3 * breakaway * uniform(-1.0, 1.0);
      side.disturbance.ripple.push_back(
          {breakaway * power_of_ten(-3.0, -0.7), power_of_ten(0.0, 3.0), uniform(0.0, 6.0)});
      side.disturbance.vibration.push_back(
          {breakaway * power_of_ten(-4.0, -0.7), power_of_ten(1.0, 4.0), uniform(0.0, 6.0)});
    }
    return side;
  }

  /// A random disturbance of the torque: a constant torque, which the contact holds from the start in some
  /// cases, ripples and vibrations.
  motion::Disturbance disturbance_of(const friction::FrictionAlongRotor& friction,
                                     motion::PlantStart& start) {
    const double breakaway = friction.uniform.breakaway;
    motion::Disturbance disturbance;
    if (random_() % 2 == 0) {
      disturbance.torque = 0.4 * breakaway * uniform(-1.0, 1.0);
      if (random_() % 2 == 0 && !start.sliding) {
        start.holding = disturbance.torque;
        start.preload = 0.0;
        start.history.clear();
      }
    }
    for (std::uint64_t i = random_() % 3; i > 0; --i)
      disturbance.ripple.push_back(
          {breakaway * power_of_ten(-3.0, -0.7), power_of_ten(0.0, 3.0), uniform(0.0, 6.0)});
    for (std::uint64_t i = random_() % 3; i > 0; --i)
      disturbance.vibration.push_back(
          {breakaway * power_of_ten(-4.0, -0.7), power_of_ten(1.0, 4.0), uniform(0.0, 6.0)});
    return disturbance;
  }

  static Json waves_of(const motion::Disturbance& disturbance) {
    Json ripple = Json::array();
    for (const motion::Ripple& r : disturbance.ripple) ripple.push_back({r.amplitude, r.per_angle, r.phase});
    Json vibration = Json::array();
    for (const motion::Vibration& v : disturbance.vibration)
      vibration.push_back({v.amplitude, v.rate, v.phase});
    return {{"torque", disturbance.torque}, {"ripple", ripple}, {"vibration", vibration}};
  }

  friction::FrictionAlongRotor contact(friction::FrictionModel model) {
    friction::FrictionAlongRotor friction;
    friction.model = model;
    friction.uniform.breakaway = power_of_ten(-1.0, 0.0);
    friction.uniform.coulomb_ratio = random_() % 4 == 0 ? 1.0 : uniform(0.5, 1.0);
    friction.uniform.stribeck_velocity = power_of_ten(-2.5, -0.5);
    friction.uniform.sigma0 = power_of_ten(2.0, 3.5);
    friction.uniform.sigma1 = power_of_ten(-2.0, 0.0);
    friction.uniform.gms_attraction = power_of_ten(0.0, 2.5);
    friction.uniform.k1 = power_of_ten(1.5, 2.5);
    friction.uniform.k2 = power_of_ten(2.0, 3.2);
    friction.uniform.beta = power_of_ten(3.5, 5.3);
    friction.uniform.alpha = power_of_ten(-1.0, 1.5);
    friction.uniform.lambda = power_of_ten(0.0, 2.0);
    if (random_() % 2 == 0) friction.uniform.n = uniform(1.0, 3.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < 1 + random_() % 5; ++i) {
      friction.gms_elements.push_back({power_of_ten(1.5, 3.0), uniform(0.01, 1.0)});
      sum += friction.gms_elements.back().weight;
    }
    for (friction::GmsElement& element : friction.gms_elements) element.weight /= sum;
    return friction;
  }

  motion::PlantStart beginning(const friction::FrictionAlongRotor& friction) {
    motion::PlantStart start{.velocity = random_() % 3 == 0 ? uniform(-0.3, 0.3) : 0.0,
                             .sliding = random_() % 2 == 0};
    using Model = friction::FrictionModel;
    if (friction.model != Model::presliding && friction.model != Model::spring) return start;
    const double most = 0.9 * friction.uniform.breakaway;
    if (random_() % 2 == 0) start.hardening = power_of_ten(-6.0, -3.0);
    if (random_() % 2 == 0) start.preload = uniform(-most, most);
    for (std::uint64_t i = random_() % 5; i > 0; --i) start.history.push_back(uniform(-most, most));
    return start;
  }

  /// The torques (N m) to which the contact is loaded one after the other before the motion starts.
  static std::vector<double> loads_of(const motion::PlantStart& start) {
    std::vector<double> loads{start.preload, 0.0};
    loads.insert(loads.end(), start.history.begin(), start.history.end());
    loads.push_back(start.holding);
    return loads;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }

  std::mt19937_64 random_{20021};
};

}  // namespace
}  // namespace zerocount

int main(int, char** arguments) {
  using namespace zerocount;
  Answers answers;
  Json cases = Json::array();
  using Model = friction::FrictionModel;
  const int motions = std::atoi(arguments[1]);
  for (int i = 0; i < motions; ++i) {
    const bool loaded = i % 2 == 1;
    const bool disturbed = i % 4 >= 2;
    const bool wide = i % 8 >= 4;
    cases.push_back(answers.motion<friction::DahlFriction>(Model::dahl, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::LuGreFriction>(Model::lugre, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::GmsFriction>(Model::gms, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::CoulombFriction>(Model::coulomb, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::NoFriction>(Model::none, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::PreslidingFriction>(Model::presliding, loaded, disturbed, wide));
    cases.push_back(answers.motion<friction::SpringFriction>(Model::spring, loaded, disturbed, wide));
  }
  std::cout << cases.dump() << '\n';
}

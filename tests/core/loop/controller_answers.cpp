// What trials with random controllers decide, for an independent implementation to judge: JSON on standard
// output. Of one kind of block alone by turns, and of all together.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>
#include <string>

#include <nlohmann/json.hpp>

#include "core/trial/trial.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

enum class Kind { none, deadband, zone, leak, derivative, filters, feedforward, observer, cascade, all };
constexpr int kinds = 10;
constexpr const char* kind_names[kinds] = {"none",    "deadband",    "zone",     "leak",    "derivative",
                                           "filters", "feedforward", "observer", "cascade", "all"};

class RandomTrials {
 public:
  trial::TrialParameters next(Kind kind, bool two_phases) {
    trial::TrialParameters p;
    p.controller.sample_rate = std::round(log_uniform(500.0, 5000.0));
    p.controller.kp = some(log_uniform(1e-5, 4e-4));
    p.controller.ki = log_uniform(1e-5, 1e-4);
    p.controller.kd = two_phases ? 0.0 : some(log_uniform(1e-4, 2e-3));
    p.controller.delay = static_cast<int>(random_() % 3);
    if (chance(0.3)) p.controller.anti_windup = loop::AntiWindup::none;
    if (chance(0.1)) p.controller.encoder = loop::EncoderChoice::coarse;
    p.controller.blocks = blocks(kind, p.controller.sample_rate);
    if (two_phases) {
      loop::CoarsePhaseParameters& c = p.controller.coarse;
      c.kp = log_uniform(1e-4, 5e-4);
      c.kd = log_uniform(1e-3, 6e-3);
      c.ki = log_uniform(1e-6, 1e-5);
      if (chance(0.3)) c.encoder = loop::EncoderChoice::coarse;
      c.fine_within = 40.0;
      c.fine_rate = 5.0;
      c.fine_dwell = 2e-3;
      c.coarse_beyond = uniform(50.0, 80.0);
      c.blocks = blocks(kind, p.controller.sample_rate);
    }
    p.command.hold = 0.15;
    const double reach = two_phases ? 400.0 : 60.0;
    for (int i = 0; i < 3; ++i) p.command.targets.push_back(std::llround(uniform(-reach, reach)));
    if (chance(kind == Kind::feedforward || kind == Kind::all ? 1.0 : 0.3)) {
      p.command.profile.shape =
          chance(0.5) ? loop::ReferenceShape::trapezoidal : loop::ReferenceShape::s_curve;
      p.command.profile.velocity_limit = log_uniform(2e-3, 5e-2);
      p.command.profile.acceleration_limit = log_uniform(0.1, 10.0);
      p.command.profile.jerk_limit = log_uniform(50.0, 1000.0);
    }
    p.initial.encoder_phase = uniform(0.0, 1.0);
    p.initial.integral = some(uniform(-0.02, 0.02));
    return p;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double some(double value) { return chance(0.7) ? value : 0.0; }

  loop::Filter filter(double sample_rate) {
    loop::Filter f;
    f.kind = static_cast<loop::FilterKind>(random_() % 4);
    f.frequency = sample_rate * log_uniform(0.02, 0.45);
    f.damping = log_uniform(0.3, 1.5);
    f.depth = uniform(0.0, 1.0);
    f.ratio = log_uniform(0.5, 4.0);
    f.a[1] = uniform(-0.5, 0.5);
    f.a[0] = uniform(-0.7, 0.7) * (1.0 + f.a[1]);
    const double sum = 1.0 + f.a[0] + f.a[1];
    f.b = {uniform(0.0, 0.5) * sum, uniform(0.0, 0.3) * sum, uniform(0.0, 0.3) * sum};
    return f;
  }

  loop::ControlBlocks blocks(Kind kind, double sample_rate) {
    const auto has = [&](Kind one) { return kind == one || (kind == Kind::all && chance(0.6)); };
    loop::ControlBlocks b;
    if (has(Kind::deadband)) {
      b.deadband.enter = static_cast<double>(random_() % 4);
      if (chance(0.5)) b.deadband.leave = b.deadband.enter + static_cast<double>(random_() % 3);
    }
    if (has(Kind::zone)) b.integrator_zone = uniform(2.0, 40.0);
    if (has(Kind::leak)) b.integrator_leak = log_uniform(0.01, 10.0);
    if (has(Kind::derivative)) b.derivative_cutoff = sample_rate * log_uniform(0.01, 0.5);
    if (has(Kind::filters)) {
      for (std::uint64_t i = random_() % 3 + 1; i > 0; --i) b.filters.push_back(filter(sample_rate));
    }
    if (has(Kind::feedforward))
      b.feedforward = {some(log_uniform(0.01, 0.5)), some(log_uniform(1e-4, 1e-2)), some(uniform(0.0, 0.1))};
    if (has(Kind::observer)) b.observer = {log_uniform(2.0, 40.0), 5.54e-4 * log_uniform(0.5, 2.0)};
    if (has(Kind::cascade)) {
      b.structure = loop::ControlStructure::cascade;
      b.cascade = {log_uniform(10.0, 200.0), log_uniform(0.02, 0.3), some(log_uniform(0.5, 20.0))};
    }
    return b;
  }

  std::mt19937_64 random_{1905};
};

Json limit(double value) {
  return value < 0.0 || value == std::numeric_limits<double>::infinity() ? Json() : Json(value);
}

Json filter_json(const loop::Filter& f) {
  switch (f.kind) {
    case loop::FilterKind::lowpass:
      return {{"lowpass", {{"frequency", f.frequency}, {"damping", f.damping}}}};
    case loop::FilterKind::notch:
      return {{"notch", {{"frequency", f.frequency}, {"damping", f.damping}, {"depth", f.depth}}}};
    case loop::FilterKind::lead:
      return {{"lead", {{"frequency", f.frequency}, {"ratio", f.ratio}}}};
    case loop::FilterKind::biquad:
      break;
  }
  return {{"biquad", {{"b", f.b}, {"a", f.a}}}};
}

void add_blocks(Json& to, const loop::ControlBlocks& b) {
  to["structure"] = b.structure == loop::ControlStructure::cascade ? "cascade" : "pid";
  to["cascade"] = {{"kv", b.cascade.kv}, {"kp", b.cascade.kp}, {"ki", b.cascade.ki}};
  to["deadband"] = {{"enter", limit(b.deadband.enter)}, {"leave", limit(b.deadband.leave)}};
  to["integrator_zone"] = limit(b.integrator_zone);
  to["integrator_leak"] = limit(b.integrator_leak);
  to["derivative_cutoff"] = limit(b.derivative_cutoff);
  to["filters"] = Json::array();
  for (const loop::Filter& f : b.filters) to["filters"].push_back(filter_json(f));
  to["feedforward"] = {{"velocity", b.feedforward.velocity},
                       {"acceleration", b.feedforward.acceleration},
                       {"friction", b.feedforward.friction}};
  to["observer"] = {{"bandwidth", b.observer.bandwidth}, {"inertia", b.observer.inertia}};
}

Json parameters_json(const trial::TrialParameters& p) {
  const auto encoder = [](loop::EncoderChoice choice) {
    return choice == loop::EncoderChoice::fine ? "fine" : "coarse";
  };
  const loop::ControllerParameters& c = p.controller;
  Json controller{{"sample_rate", c.sample_rate},
                  {"kp", c.kp},
                  {"ki", c.ki},
                  {"kd", c.kd},
                  {"anti_windup", c.anti_windup == loop::AntiWindup::clamp ? "clamp" : "none"},
                  {"encoder", encoder(c.encoder)}};
  add_blocks(controller, c.blocks);
  Json coarse{{"kp", c.coarse.kp},
              {"ki", c.coarse.ki},
              {"kd", c.coarse.kd},
              {"encoder", encoder(c.coarse.encoder)},
              {"fine_within", c.coarse.fine_within},
              {"fine_rate", c.coarse.fine_rate},
              {"fine_dwell", c.coarse.fine_dwell},
              {"coarse_beyond", limit(c.coarse.coarse_beyond)}};
  add_blocks(coarse, c.coarse.blocks);
  controller["coarse"] = coarse;
  const loop::ReferenceProfile& profile = p.command.profile;
  constexpr const char* shapes[] = {"step", "trapezoidal", "s_curve"};
  return {{"encoder", {{"fine", p.encoder.fine}, {"coarse", p.encoder.coarse}}},
          {"dac", {{"bits", p.dac.bits}, {"resolution", p.dac.resolution}}},
          {"controller", controller},
          {"command",
           {{"targets", p.command.targets},
            {"hold", p.command.hold},
            {"profile",
             {{"shape", shapes[static_cast<int>(profile.shape)]},
              {"velocity_limit", profile.velocity_limit},
              {"acceleration_limit", profile.acceleration_limit},
              {"jerk_limit", profile.jerk_limit}}}}},
          {"initial", {{"integral", p.initial.integral}}}};
}

void print() {
  RandomTrials trials;
  Json all = Json::array();
  for (int i = 0; i < 12 * kinds; ++i) {
    const int kind = i % kinds;
    const trial::TrialParameters p = trials.next(static_cast<Kind>(kind), i / kinds % 2 == 1);
    Json samples = Json::array();
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& r) {
      samples.push_back(
          {r.target, r.count, r.coarse_count, r.code, r.torque, r.phase == loop::ControlPhase::coarse});
    };
    trial::run_trial(p, observers);
    all.push_back({{"blocks", kind_names[kind]}, {"parameters", parameters_json(p)}, {"samples", samples}});
  }
  std::cout << all << "\n";
}

}  // namespace
}  // namespace zerocount

int main() {
  zerocount::print();
}

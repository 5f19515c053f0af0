// What trials with random controllers decide, for an independent implementation to judge: JSON on standard
// output. Of one kind of block alone by turns, and of all together.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>

#include <nlohmann/json.hpp>

#include "core/trial/trial.hpp"
#include "tests/core/loop/controller_json.hpp"
#include "tests/core/loop/random_blocks.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;
using testing::BlockKind;
using testing::RandomBlocks;

class RandomTrials {
 public:
  trial::TrialParameters next(BlockKind kind, bool two_phases) {
    trial::TrialParameters p;
    p.controller.sample_rate = std::round(draw_.log_uniform(500.0, 5000.0));
    p.controller.kp = draw_.some(draw_.log_uniform(1e-5, 4e-4));
    p.controller.ki = draw_.log_uniform(1e-5, 1e-4);
    p.controller.kd = two_phases ? 0.0 : draw_.some(draw_.log_uniform(1e-4, 2e-3));
    p.controller.delay = static_cast<int>(draw_.integer() % 3);
    if (draw_.chance(0.3)) p.controller.anti_windup = loop::AntiWindup::none;
    if (draw_.chance(0.1)) p.controller.encoder = loop::EncoderChoice::coarse;
    p.controller.blocks = draw_.blocks(kind, p.controller.sample_rate);
    draw_.add_drive(p.controller.blocks);
    if (draw_.chance(0.2)) p.dac.limit = draw_.log_uniform(1e-2, 1.0);
    if (two_phases) {
      loop::CoarsePhaseParameters& c = p.controller.coarse;
      c.kp = draw_.log_uniform(1e-4, 5e-4);
      c.kd = draw_.log_uniform(1e-3, 6e-3);
      c.ki = draw_.log_uniform(1e-6, 1e-5);
      if (draw_.chance(0.3)) c.encoder = loop::EncoderChoice::coarse;
      c.fine_within = 40.0;
      c.fine_rate = 5.0;
      c.fine_dwell = 2e-3;
      c.coarse_beyond = draw_.uniform(50.0, 80.0);
      c.blocks = draw_.blocks(kind, p.controller.sample_rate);
    }
    p.command.hold = 0.15;
    const double reach = two_phases ? 400.0 : 60.0;
    for (int i = 0; i < 3; ++i) p.command.targets.push_back(std::llround(draw_.uniform(-reach, reach)));
    if (draw_.chance(kind == BlockKind::feedforward || kind == BlockKind::all ? 1.0 : 0.3)) {
      p.command.profile.shape =
          draw_.chance(0.5) ? loop::ReferenceShape::trapezoidal : loop::ReferenceShape::s_curve;
      p.command.profile.velocity_limit = draw_.log_uniform(2e-3, 5e-2);
      p.command.profile.acceleration_limit = draw_.log_uniform(0.1, 10.0);
      p.command.profile.jerk_limit = draw_.log_uniform(50.0, 1000.0);
    }
    p.initial.encoder_phase = draw_.uniform(0.0, 1.0);
    p.initial.integral = draw_.some(draw_.uniform(-0.02, 0.02));
    return p;
  }

 private:
  RandomBlocks draw_{1905};
};

Json parameters_json(const trial::TrialParameters& p) {
  const loop::ReferenceProfile& profile = p.command.profile;
  constexpr const char* shapes[] = {"step", "trapezoidal", "s_curve"};
  return {{"amplifier", {{"limit", testing::limit_json(p.dac.limit)}}},
          {"encoder", {{"fine", p.encoder.fine}, {"coarse", p.encoder.coarse}}},
          {"dac", {{"bits", p.dac.bits}, {"resolution", p.dac.resolution}}},
          {"controller", testing::controller_json(p.controller)},
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
  for (int i = 0; i < 12 * testing::block_kinds; ++i) {
    const int kind = i % testing::block_kinds;
    const trial::TrialParameters p =
        trials.next(static_cast<BlockKind>(kind), i / testing::block_kinds % 2 == 1);
    Json samples = Json::array();
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& r) {
      samples.push_back(
          {r.target, r.count, r.coarse_count, r.code, r.torque, r.phase == loop::ControlPhase::coarse});
    };
    trial::run_trial(p, observers);
    all.push_back({{"blocks", testing::block_kind_names[kind]},
                   {"parameters", parameters_json(p)},
                   {"samples", samples}});
  }
  std::cout << all << "\n";
}

}  // namespace
}  // namespace zerocount

int main() {
  zerocount::print();
}

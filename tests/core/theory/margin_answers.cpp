// The margins of random loops, for an independent implementation to judge: JSON on standard output.
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>

#include <nlohmann/json.hpp>

#include "core/theory/margins.hpp"
#include "tests/core/loop/controller_json.hpp"
#include "tests/core/loop/random_blocks.hpp"
#include "tests/core/theory/frozen_loops.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

Json margin_json(const theory::Margin& margin) {
  if (std::isnan(margin.value)) return nullptr;
  return {margin.value, margin.frequency};
}

void print() {
  testing::RandomBlocks draw(1998);
  Json all = Json::array();
  for (int i = 0; i < 20 * testing::block_kinds; ++i) {
    loop::ControllerParameters controller;
    controller.sample_rate = std::round(draw.log_uniform(500.0, 2e4));
    controller.kp = draw.some(draw.log_uniform(1e-5, 4e-4));
    controller.ki = draw.some(draw.log_uniform(1e-6, 1e-4));
    controller.kd = draw.some(draw.log_uniform(1e-4, 5e-3));
    controller.delay = static_cast<double>(draw.integer() % 13) / 4.0;
    const auto kind = static_cast<testing::BlockKind>(i % testing::block_kinds);
    controller.blocks = draw.blocks(kind, controller.sample_rate);
    draw.add_drive(controller.blocks);
    const double stiffness = draw.chance(0.3) ? 0.0 : draw.log_uniform(30.0, 2000.0);
    const double damping = draw.log_uniform(1e-3, 0.5);
    const theory::LinearDrive drive{draw.log_uniform(0.8, 1.25), draw.some(draw.log_uniform(100.0, 2000.0))};
    motion::PlantParameters plant;
    loop::EncoderParameters encoder;
    if (draw.chance(0.4)) {
      motion::LoadParameters& load = plant.load;
      load.inertia = draw.log_uniform(1e-4, 1e-3);
      load.stiffness = draw.log_uniform(100.0, 3000.0);
      load.damping = 0.2 * std::sqrt(load.stiffness * load.inertia) * draw.log_uniform(0.5, 2.0);
      load.encoder = draw.chance(0.5) ? motion::EncoderPlace::load : motion::EncoderPlace::motor;
      encoder.other = {std::round(draw.log_uniform(1e4, 1e7)), 2.0 * std::numbers::pi};
      controller.velocity_by_other =
          controller.blocks.structure == loop::ControlStructure::cascade && draw.chance(0.7);
    }
    const theory::FrozenLoop loop =
        theory::frozen_loop(stiffness, damping, plant, encoder, controller, drive);
    const theory::StabilityMargins margins = theory::stability_margins(loop);
    all.push_back({{"blocks", testing::block_kind_names[i % testing::block_kinds]},
                   {"controller", testing::controller_json(controller)},
                   {"delay", controller.delay},
                   {"inertia", plant.inertia},
                   {"load",
                    {{"inertia", plant.load.inertia},
                     {"stiffness", plant.load.stiffness},
                     {"damping", plant.load.damping}}},
                   {"position_at_load", plant.load.encoder == motion::EncoderPlace::load},
                   {"velocity_by_other", controller.velocity_by_other},
                   {"fine", encoder.fine},
                   {"stiffness", stiffness},
                   {"damping", damping},
                   {"gain", drive.gain},
                   {"bandwidth", drive.bandwidth},
                   {"stable", theory::spectral_radius(loop.plant, loop.controller) < 1.0},
                   {"gain_margin", margin_json(margins.gain)},
                   {"phase_margin", margin_json(margins.phase)},
                   {"peak_sensitivity", margin_json(theory::peak_sensitivity(loop))}});
  }
  std::cout << all << "\n";
}

}  // namespace
}  // namespace zerocount

int main() {
  zerocount::print();
}

// Which trials lanes run, and that those they do not run are told apart by every parameter that matters.
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/batch/batched_trials.hpp"
#include "tests/core/batch/bench_trials.hpp"

namespace zerocount::testing {
namespace {

struct Change {
  const char* what;
  std::function<void(trial::TrialParameters&)> make;
};

trial::TrialParameters plain_trial() {
  return bench_trials("bench-transient", 0, 1).front();
}

TEST(RunsInLanes, IsTrueOfAPlainTrialWithAnyPlainParameters) {
  const auto exponents = std::make_shared<const friction::Profile>(
      friction::Profile{friction::Marginal::lognormal, std::log(2.5), 0.1, {0.0, 1.0}, {0.0, 0.5}});
  const Change changes[] = {
      {"nothing", [](trial::TrialParameters&) {}},
      {"gains", [](trial::TrialParameters& p) { p.controller.kp = p.controller.kd = 1e-4; }},
      {"delay", [](trial::TrialParameters& p) { p.controller.delay = 5; }},
      {"anti-windup", [](trial::TrialParameters& p) { p.controller.anti_windup = loop::AntiWindup::none; }},
      {"moves",
       [](trial::TrialParameters& p) {
         p.command.targets = {1, 2, 3};
       }},
      {"torque levels",
       [](trial::TrialParameters& p) { p.command.targets = {}, p.command.torque.levels = {0.1}; }},
      {"early decision", [](trial::TrialParameters& p) { p.verdict.stop = true; }},
      {"sliding",
       [](trial::TrialParameters& p) {
         p.initial.mode = trial::InitialMode::slide, p.initial.velocity = 1.0;
       }},
      {"history",
       [](trial::TrialParameters& p) {
         p.initial.history = {10, 0.1};
       }},
      {"the spring alone",
       [](trial::TrialParameters& p) { p.friction.model = friction::FrictionModel::spring; }},
      {"no friction", [](trial::TrialParameters& p) { p.friction.model = friction::FrictionModel::none; }},
      {"coulomb", [](trial::TrialParameters& p) { p.friction.model = friction::FrictionModel::coulomb; }},
      {"dahl", [](trial::TrialParameters& p) { p.friction.model = friction::FrictionModel::dahl; }},
      {"lugre", [](trial::TrialParameters& p) { p.friction.model = friction::FrictionModel::lugre; }},
      {"another exponent", [](trial::TrialParameters& p) { p.friction.uniform.n = 1.5; }},
      {"four filters", [](trial::TrialParameters& p) { p.controller.blocks.filters.resize(4); }},
      {"trapezoidal",
       [](trial::TrialParameters& p) { p.command.profile.shape = loop::ReferenceShape::trapezoidal; }},
      {"s_curve", [](trial::TrialParameters& p) { p.command.profile.shape = loop::ReferenceShape::s_curve; }},
      {"two phases", [](trial::TrialParameters& p) { p.controller.coarse.coarse_beyond = 3.0; }},
      {"coarse encoder",
       [](trial::TrialParameters& p) { p.controller.encoder = loop::EncoderChoice::coarse; }},
      {"eccentricity", [](trial::TrialParameters& p) { p.encoder.fine_errors.eccentricity = 1e-4; }},
      {"interpolation", [](trial::TrialParameters& p) { p.encoder.fine_errors.interpolation = 0.2; }},
      {"noise", [](trial::TrialParameters& p) { p.encoder.fine_errors.noise = 0.1; }},
      {"missed counts", [](trial::TrialParameters& p) { p.encoder.fine_errors.missed = 0.01; }},
      {"noise of the coarse encoder", [](trial::TrialParameters& p) { p.encoder.coarse_errors.noise = 1.0; }},
      {"offset", [](trial::TrialParameters& p) { p.dac.offset = 1e-3; }},
      {"gain error", [](trial::TrialParameters& p) { p.dac.gain_error = 0.01; }},
      {"nonlinearity", [](trial::TrialParameters& p) { p.dac.nonlinearity = 1.0; }},
      {"noise of the converter", [](trial::TrialParameters& p) { p.dac.noise = 1e-4; }},
      {"five filters", [](trial::TrialParameters& p) { p.controller.blocks.filters.resize(5); }},
      {"missed samples", [](trial::TrialParameters& p) { p.controller.missed = 0.1; }},
      {"a long delay", [](trial::TrialParameters& p) { p.controller.delay = 1000; }},
      {"amplifier", [](trial::TrialParameters& p) { p.amplifier.bandwidth = 500.0; }},
      {"jitter", [](trial::TrialParameters& p) { p.controller.jitter = 1e-5; }},
      {"a ripple",
       [](trial::TrialParameters& p) {
         p.disturbance.ripple = {{1e-3, 10.0, 0.0, 0.0}};
       }},
      {"a vibration",
       [](trial::TrialParameters& p) {
         p.disturbance.vibration = {{1e-3, 50.0, 0.0}};
       }},
      {"a constant disturbance", [](trial::TrialParameters& p) { p.disturbance.torque = 0.01; }},
      {"a cascade",
       [](trial::TrialParameters& p) { p.controller.blocks.structure = loop::ControlStructure::cascade; }},
      {"an observer", [](trial::TrialParameters& p) { p.controller.blocks.observer.bandwidth = 10.0; }},
      {"an exponent along the rotor",
       [&](trial::TrialParameters& p) {
         p.friction.profiled = {{&friction::FrictionParameters::n, exponents}};
       }},
  };
  for (const Change& change : changes) {
    trial::TrialParameters p = plain_trial();
    change.make(p);
    EXPECT_TRUE(batch::runs_in_lanes(p)) << change.what;
  }
}

TEST(RunsInLanes, IsFalseOfWhatLanesDoNotKnowWhichThenIsTheReferences) {
  const Change changes[] = {
      {"no moves", [](trial::TrialParameters& p) { p.command.targets = {}; }},
      {"no samples", [](trial::TrialParameters& p) { p.command.hold = 1e-5; }},
      {"a level without samples",
       [](trial::TrialParameters& p) {
         p.command.targets = {}, p.command.torque.levels = {0.1, 0.1}, p.command.hold = 0.0;
       }},
      {"a fast vibration",
       [](trial::TrialParameters& p) {
         p.disturbance.vibration = {{1e-3, 1100.0, 0.0}};
       }},
      {"a ripple without friction",
       [](trial::TrialParameters& p) {
         p.friction.model = friction::FrictionModel::none;
         p.disturbance.ripple = {{1e-3, 10.0, 0.0, 0.0}};
       }},
      {"seventeen elements",
       [](trial::TrialParameters& p) {
         p.friction.model = friction::FrictionModel::gms;
         p.friction.gms_elements.assign(17, {100.0, 1.0 / 17.0});
       }},
  };
  std::vector<trial::TrialParameters> trials;
  for (const Change& change : changes) {
    trials.push_back(plain_trial());
    change.make(trials.back());
    EXPECT_FALSE(batch::runs_in_lanes(trials.back())) << change.what;
  }
  const std::vector<BatchedTrial> batched = run_batch(trials, {.lanes = 4});
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(difference_in_bits(batched[i], run_by_reference(trials[i])), "") << changes[i].what;
  }
}

}  // namespace
}  // namespace zerocount::testing

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
  std::function<void(TrialParameters&)> make;
};

TrialParameters plain_trial() {
  return bench_trials("bench-transient", 0, 1).front();
}

TEST(RunsInLanes, IsTrueOfAPlainTrialWithAnyPlainParameters) {
  const auto exponents = std::make_shared<const Profile>(
      Profile{Marginal::lognormal, std::log(2.5), 0.1, {0.0, 1.0}, {0.0, 0.5}});
  const Change changes[] = {
      {"nothing", [](TrialParameters&) {}},
      {"gains", [](TrialParameters& p) { p.controller.kp = p.controller.kd = 1e-4; }},
      {"delay", [](TrialParameters& p) { p.controller.delay = 5; }},
      {"anti-windup", [](TrialParameters& p) { p.controller.anti_windup = AntiWindup::none; }},
      {"moves",
       [](TrialParameters& p) {
         p.command.targets = {1, 2, 3};
       }},
      {"early decision", [](TrialParameters& p) { p.verdict.stop = true; }},
      {"sliding", [](TrialParameters& p) { p.initial.mode = InitialMode::slide, p.initial.velocity = 1.0; }},
      {"history",
       [](TrialParameters& p) {
         p.initial.history = {10, 0.1};
       }},
      {"the spring alone", [](TrialParameters& p) { p.friction.model = FrictionModel::spring; }},
      {"another exponent", [](TrialParameters& p) { p.friction.uniform.n = 1.5; }},
      {"an exponent along the rotor",
       [&](TrialParameters& p) {
         p.friction.profiled = {{&FrictionParameters::n, exponents}};
       }},
  };
  for (const Change& change : changes) {
    TrialParameters p = plain_trial();
    change.make(p);
    EXPECT_TRUE(runs_in_lanes(p)) << change.what;
  }
}

TEST(RunsInLanes, IsFalseOfWhatLanesDoNotKnowWhichThenIsTheReferences) {
  const Change changes[] = {
      {"torque levels", [](TrialParameters& p) { p.command.targets = {}, p.command.torque.levels = {0.1}; }},
      {"no moves", [](TrialParameters& p) { p.command.targets = {}; }},
      {"no samples", [](TrialParameters& p) { p.command.hold = 1e-5; }},
      {"trapezoidal", [](TrialParameters& p) { p.command.profile.shape = ReferenceShape::trapezoidal; }},
      {"s_curve", [](TrialParameters& p) { p.command.profile.shape = ReferenceShape::s_curve; }},
      {"two phases", [](TrialParameters& p) { p.controller.coarse.coarse_beyond = 3.0; }},
      {"coarse encoder", [](TrialParameters& p) { p.controller.encoder = EncoderChoice::coarse; }},
      {"a long delay", [](TrialParameters& p) { p.controller.delay = 1000; }},
      {"eccentricity", [](TrialParameters& p) { p.encoder.fine_errors.eccentricity = 1e-4; }},
      {"interpolation", [](TrialParameters& p) { p.encoder.fine_errors.interpolation = 0.2; }},
      {"noise", [](TrialParameters& p) { p.encoder.fine_errors.noise = 0.1; }},
      {"missed counts", [](TrialParameters& p) { p.encoder.fine_errors.missed = 0.01; }},
      {"noise of the coarse encoder", [](TrialParameters& p) { p.encoder.coarse_errors.noise = 1.0; }},
      {"offset", [](TrialParameters& p) { p.dac.offset = 1e-3; }},
      {"gain error", [](TrialParameters& p) { p.dac.gain_error = 0.01; }},
      {"nonlinearity", [](TrialParameters& p) { p.dac.nonlinearity = 1.0; }},
      {"noise of the converter", [](TrialParameters& p) { p.dac.noise = 1e-4; }},
      {"amplifier", [](TrialParameters& p) { p.amplifier.bandwidth = 500.0; }},
      {"coulomb", [](TrialParameters& p) { p.friction.model = FrictionModel::coulomb; }},
      {"no friction", [](TrialParameters& p) { p.friction.model = FrictionModel::none; }},
  };
  std::vector<TrialParameters> trials;
  for (const Change& change : changes) {
    trials.push_back(plain_trial());
    change.make(trials.back());
    EXPECT_FALSE(runs_in_lanes(trials.back())) << change.what;
  }
  const std::vector<BatchedTrial> batched = run_batch(trials, {.lanes = 4});
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(difference_in_bits(batched[i], run_by_reference(trials[i])), "") << changes[i].what;
  }
}

}  // namespace
}  // namespace zerocount::testing

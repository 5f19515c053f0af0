// Draws with what trials share kept, beside single draws of the same trials.
#include "experiments/study/trial_drawer.hpp"

#include "experiments/study/plan.hpp"
#include "experiments/study/point_edit.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

using Bits = std::vector<std::uint64_t>;

void add_bits(Bits& bits, double number) {
  bits.push_back(std::bit_cast<std::uint64_t>(number));
}
void add_bits(Bits& bits, const std::vector<double>& numbers) {
  bits.push_back(numbers.size());
  for (const double number : numbers) add_bits(bits, number);
}
void add_bits(Bits& bits, const random::RandomKey& key) {
  bits.insert(bits.end(), key.begin(), key.end());
}
void add_bits(Bits& bits, const friction::Profile& profile) {
  bits.push_back(static_cast<std::uint64_t>(profile.marginal));
  for (const double number : {profile.location, profile.scale, profile.period}) add_bits(bits, number);
  add_bits(bits, profile.cosine);
  add_bits(bits, profile.sine);
}

/// A number that tells the parameters apart: all defaults differ.
double name_of(double friction::FrictionParameters::*parameter) {
  return friction::FrictionParameters{}.*parameter;
}

/// The friction beside the numbers of parameters: profiles, the values of some contacts, and elements.
Bits bits_of(const friction::FrictionAlongRotor& friction) {
  Bits bits{friction.profiled.size(), friction.per_contact.size(), friction.gms_elements.size()};
  for (const friction::ProfiledParameter& entry : friction.profiled) {
    add_bits(bits, name_of(entry.parameter));
    add_bits(bits, *entry.profile);
  }
  for (const friction::ContactParameter& entry : friction.per_contact) {
    add_bits(bits, name_of(entry.parameter));
    for (const std::uint64_t contact : {1U, 2U, 77U}) add_bits(bits, entry.value(contact));
  }
  for (const friction::GmsElement& element : friction.gms_elements)
    for (const double number : {element.stiffness, element.weight}) add_bits(bits, number);
  return bits;
}

Bits bits_of(const random::TrialRandomness& randomness) {
  Bits bits{randomness.trial, randomness.stream};
  for (const random::RandomKey& key :
       {randomness.history, randomness.fine_noise, randomness.fine_missed, randomness.coarse_noise,
        randomness.coarse_missed, randomness.dac_noise, randomness.missed_samples, randomness.jitter,
        randomness.spectrum})
    add_bits(bits, key);
  return bits;
}

/// The moves, beside the numbers of parameters.
Bits bits_of(const trial::CommandParameters& command) {
  Bits bits;
  for (const std::int64_t target : command.targets) bits.push_back(static_cast<std::uint64_t>(target));
  add_bits(bits, command.exact_targets);
  add_bits(bits, command.torque.levels);
  bits.push_back(command.torque.record != nullptr);
  return bits;
}

/// The numbers of all parameters, in the order of the table; the lengths of their lists.
Bits bits_of(const Study& study, const trial::TrialParameters& parameters) {
  Bits bits{parameters.controller.blocks.filters.size(), parameters.controller.coarse.blocks.filters.size(),
            parameters.disturbance.ripple.size(), parameters.disturbance.vibration.size(),
            parameters.disturbance.spectra.size()};
  for (const parameters::Parameter& row : study.plan->table.rows)
    if (row.get) add_bits(bits, row.get(parameters));
  bits.push_back(parameters.controller.user.plugin != nullptr);
  add_bits(bits, parameters.controller.user.parameters);
  return bits;
}

void expect_equal(const Study& study, const StudyTrial& drawn, const StudyTrial& single) {
  EXPECT_EQ(drawn.inputs.size(), study.columns.inputs.size());
  Bits inputs, same_inputs;
  add_bits(inputs, drawn.inputs);
  add_bits(same_inputs, single.inputs);
  EXPECT_EQ(inputs, same_inputs);
  EXPECT_EQ(drawn.target_positions, single.target_positions);
  EXPECT_EQ(bits_of(study, drawn.parameters), bits_of(study, single.parameters));
  EXPECT_EQ(bits_of(drawn.parameters.friction), bits_of(single.parameters.friction));
  EXPECT_EQ(bits_of(drawn.parameters.randomness), bits_of(single.parameters.randomness));
  EXPECT_EQ(bits_of(drawn.parameters.command), bits_of(single.parameters.command));
}

/// Values of every distribution but that of samples, with random spreads: seven, and that of the target.
std::string random_spreads(testing::Draws& draws) {
  const double low = draws.log_uniform(0.01, 1.0), high = low * draws.log_uniform(1.1, 50.0);
  const double mean = draws.uniform(300.0, 900.0), sd = draws.log_uniform(1.0, 200.0);
  const double limit = mean + sd * draws.uniform(-0.5, 3.0);  // one tail, or both
  return manifest_commanding(
      fmt::format("{{targets: [{{integers: [{}, {}]}}, 2]}}", draws.integer(1, 5), draws.integer(6, 40)),
      fmt::format("friction:\n"
                  "  k1: {{lognormal: {{median: {}, cv: {}}}}}\n"
                  "  k2: {{truncated_normal: {{mean: {}, sd: {}, low: {}, high: {}}}}}\n"
                  "  beta: {{triangular: [1.0e+4, {}, 9.0e+4]}}\n"
                  "  alpha: {{log_uniform: [{}, {}]}}\n"
                  "  lambda: {{uniform: [{}, {}]}}\n"
                  "  n: {{choice: [1.5, 2, 2.5]}}\n"
                  "initial: {{position: {{normal: {{mean: {}, sd: {}}}}}}}\n",
                  draws.uniform(50.0, 200.0), draws.log_uniform(0.01, 1.0), mean, sd, limit,
                  limit + draws.uniform(0.1, 3.0) * sd, draws.uniform(2e4, 8e4), low, high, 10.0 * low,
                  10.0 * high, draws.uniform(-2.0, 2.0), draws.log_uniform(0.01, 2.0)));
}

/// Machines of worlds that bear conditions and age, with profiles, values that differ from contact to
/// contact, correlated values, and targets in SI units that tolerances need unrounded.
const std::string aging_machines =
    "zerocount: 1\nname: machines\nseed: 5\nrigs: 4\nworlds: 2\ntrials: 48\n"
    "ages: {at: [0, 10], unit: h}\n"
    "conditions: {a: {}, b: {friction.k2: {uniform: [500, 600]}, controller.delay: {uniform: [0.5, 1.5]}}}\n"
    "plant: {inertia: {uniform: [5.0e-4, 6.0e-4]}, presliding_damping: {uniform: [0.1, 0.3]}}\n"
    "correlation: [[plant.inertia, plant.presliding_damping, 0.4]]\n"
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.1}}, cv: 0.1, correlation_length: 0.3},\n"
    "       aging: {linear: -0.05, scale: 10}}\n"
    "  k2: {uniform: [600, 900], aging: {exponential: {normal: {mean: -0.1, sd: 0.02}}, scale: 10}}\n"
    "  lambda: {uniform: [5, 20], per: trial}\n"
    "  alpha: {uniform: [0.1, 0.9], per: study}\n"
    "  beta: {uniform: [1.0e5, 2.0e5], per: contact}\n"
    "  breakaway: {lognormal: {median: 0.3, cv: 0.1}, per: world}\n"
    "encoder: {fine: {integers: [1000000, 2000000]}, fine_errors: {noise: 0.1}}\n"
    "initial: {position: {normal: {mean: 3, sd: 1}}, hardening: {uniform: [0, 1.0e-6]}}\n"
    "command: {units: si, targets: [{uniform: [-1.0e-4, 1.0e-4]}, 1.0e-4], hold: 0.004}\n"
    "verdict: {dwell: 0.001, window: 0.001}\n";

/// Friction that follows from measured values, of which some differ from contact to contact.
const std::string measured_friction =
    "friction: {measured: {initial_stiffness: {uniform: [600, 900], per: contact}, final_stiffness: "
    "{uniform: [90, 120]}, breakaway: {uniform: [0.29, 0.31], per: contact}, breakaway_travel: 2.0e-3}}\n";

/// A sequence of moves with targets in SI units.
const std::string sequence_in_rad =
    "{units: si, sequence: {targets: [-0.01, {uniform: [-1.0e-3, 1.0e-3]}, 0.02], overrun: 1.0e-3, cycles: "
    "2, approach: bidirectional}}";

void expect_same_draws(const Study& study, TrialDrawer& drawer, StudyTrial& trial, testing::Draws& draws) {
  for (int i = 0; i < 40; ++i) {
    const std::int64_t point = draws.integer(0, point_count(study) - 1);
    const std::int64_t index = draws.integer(0, study.trials - 1);
    drawer.draw(point, index, trial);
    SCOPED_TRACE(fmt::format("{}, point {}, trial {}", study.name, point, index));
    expect_equal(study, trial, study_trial(study, point, index));
    if (draws.chance(0.5)) trial.inputs = {};  // as a runner takes them away
  }
}

TEST(TrialDrawer, DrawsTheBitsOfSingleTrials) {
  testing::Draws draws(20260131);
  for (const std::string design : {"monte_carlo", "latin_hypercube", "sobol", "saltelli"}) {
    for (int round = 0; round < 8; ++round) {
      std::string text = random_spreads(draws);
      if (round % 2 == 1)
        text +=
            "sweep: {cases: {a: {friction.alpha: 0.5}, b: {friction.alpha: {log_uniform: [0.2, 0.7]}}}}\n";
      const Study study = study_of(text, {"trials=640", "design=" + design});
      TrialDrawer drawer(study);
      StudyTrial trial;
      expect_same_draws(study, drawer, trial, draws);
    }
  }
}

// One trial is the memory of all its draws: no list of the draw before may stay in it.
TEST(TrialDrawer, DrawsTheBitsOfSingleTrialsWithWhateverAStudyHas) {
  testing::Draws draws(20260133);
  for (const Study& study :
       {study_of(full_manifest()), study_of(extended_manifest()), study_of(aging_machines),
        study_of(aging_machines, {"design=sobol"}), study_of(minimal_manifest(measured_friction)),
        study_of(manifest_commanding(sequence_in_rad))}) {
    TrialDrawer drawer(study);
    StudyTrial trial;
    expect_same_draws(study, drawer, trial, draws);
  }
}

// A point that is changed has spreads of its own, in a plan of its own.
TEST(TrialDrawer, FollowsAChangedPoint) {
  testing::Draws draws(20260132);
  for (int round = 0; round < 8; ++round) {
    Study study = study_of(random_spreads(draws), {"trials=64"});
    TrialDrawer drawer(study);
    StudyTrial trial;
    PointEdit edit(study, 0);
    for (int change = 0; change < 4; ++change) {
      expect_same_draws(study, drawer, trial, draws);
      edit.scale("friction.k1", draws.uniform(0.5, 2.0));
      edit.scale("friction.alpha", draws.uniform(0.5, 2.0));
      edit.scale("friction.lambda", draws.uniform(0.5, 2.0));
      edit.widen(draws.uniform(0.5, 1.5));
      study = edit.study();
    }
    study = study_of(random_spreads(draws), {"trials=64"});
    expect_same_draws(study, drawer, trial, draws);
  }
}

}  // namespace
}  // namespace zerocount::study

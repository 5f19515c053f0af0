// Draws with what trials share kept, beside single draws of the same trials.
#include "experiments/study/plan.hpp"
#include "experiments/study/point_edit.hpp"
#include "experiments/study/trial_draws.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/draws.hpp"

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

/// A number that identifies the member of the friction parameters: its default, because all defaults differ.
double name_of(double friction::FrictionParameters::*parameter) {
  return friction::FrictionParameters{}.*parameter;
}

/// The bits of a trial's friction that are not numbers of parameters: profiles along the rotor, the values of
/// some contacts, and elements.
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

/// The bits of a trial's command that are not numbers of parameters: its moves.
Bits bits_of(const trial::CommandParameters& command) {
  Bits bits;
  for (const std::int64_t target : command.targets) bits.push_back(static_cast<std::uint64_t>(target));
  add_bits(bits, command.exact_targets);
  add_bits(bits, command.torque.levels);
  bits.push_back(command.torque.record != nullptr);
  return bits;
}

/// The bits of all parameters of a trial, in the order of the table, and the lengths of their lists.
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

/// A manifest with a value of every distribution except samples, with random spreads: seven values and the
/// target.
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
    "zerocount: 1\nname: machines\nseed: 5\nmachines: 4\nworlds: 2\ntrials: 48\n"
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

/// Friction that follows from measured values. Initial stiffness and breakaway are drawn per contact: anew at
/// t = 0 and whenever the sliding friction sticks again.
const std::string measured_friction =
    "friction: {measured: {initial_stiffness: {uniform: [600, 900], per: contact}, final_stiffness: "
    "{uniform: [90, 120]}, breakaway: {uniform: [0.29, 0.31], per: contact}, breakaway_travel: 2.0e-3}}\n";

/// Manifest text of a command: a sequence of moves with targets in SI units.
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

TEST(TrialDrawer, EqualsSingleTrialsBitForBit) {
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
TEST(TrialDrawer, EqualsSingleTrialsBitForBitWithEveryFeature) {
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

// Trials as earlier versions of this program drew them: a manifest has the same trials for ever.

struct RecordedTrial {
  const char* design;
  const char* independent;
  std::int64_t point;
  std::int64_t index;
  std::vector<double> inputs;  // of full_manifest()
};

const std::vector<RecordedTrial> recorded{
    RecordedTrial{"monte_carlo",
                  "false",
                  5,
                  123,
                  {0.0006, 102.73966471368907, 862.6947079910299, 199846.89937849462, 0.9262956628696883,
                   0.2870621690814896, 0.0003, 3.85e-05, 1, 0, 13, 0.9842529855420333, 1.9148335932385823,
                   -0.003934104920719751}},
    RecordedTrial{"monte_carlo",
                  "false",
                  11,
                  999,
                  {0.0006, 98.47908829134342, 882.38253005278, 221451.4258251076, 0.12067245737154708,
                   0.29151022070450777, 0.0003, 9.45e-05, 1, 1, 19, 0.6838954054432377, 1.6462506014176337,
                   0.00692129817852626}},
    RecordedTrial{"monte_carlo",
                  "true",
                  5,
                  123,
                  {0.0006, 102.38715464284829, 760.264917972189, 231102.75117982432, 0.5391536387604396,
                   0.2707031335128402, 0.0003, 3.85e-05, 0, 0, 21, 0.8609043332912297, 1.9026048299981797,
                   -0.013726746076024378}},
    RecordedTrial{"monte_carlo",
                  "true",
                  11,
                  999,
                  {0.0006, 102.63899994467624, 631.8260501641521, 211414.22350076557, 0.24770496405093584,
                   0.2946821349680618, 0.0003, 9.45e-05, 1, 1, 17, 0.029341355185455886, 1.216048996722621,
                   -0.015143731549369672}},
    RecordedTrial{"latin_hypercube",
                  "false",
                  5,
                  123,
                  {0.0006, 125.51520008342595, 608.662694707991, 181446.0485423161, 0.5799229915750018,
                   0.3124683280998171, 0.0003, 3.85e-05, 0, 0, 3, 0.308984252985542, 3.017895583835117,
                   0.014400730996470384}},
    RecordedTrial{"latin_hypercube",
                  "false",
                  11,
                  999,
                  {0.0006, 111.42463661288284, 673.7823825300528, 150950.41071969437, 0.5226971904931184,
                   0.311812608080977, 0.0003, 9.45e-05, 0, 1, 20, 0.9206838954054432, 4.2377084531248865,
                   -7.733468935505313e-05}},
    RecordedTrial{"latin_hypercube",
                  "true",
                  5,
                  123,
                  {0.0006, 109.85426956792803, 691.6602649179722, 204299.8245195353, 1.0743541582877811,
                   0.3000042863811031, 0.0003, 3.85e-05, 1, 0, 3, 0.2988609043332912, 2.6069363470171187,
                   -0.0014873038264617494}},
    RecordedTrial{"latin_hypercube",
                  "true",
                  11,
                  999,
                  {0.0006, 112.13370616160798, 610.5318260501641, 168035.00367087516, 0.6489879781473471,
                   0.3073619476662606, 0.0003, 9.45e-05, 0, 1, 22, 0.25302934135518546, 1.5392149200600265,
                   -0.011143719909553243}},
    RecordedTrial{"sobol",
                  "false",
                  5,
                  123,
                  {0.0006, 107.17311418988021, 868.685033747184, 220262.2652026604, 0.13706812248423986,
                   0.30904352555071607, 0.0003, 3.85e-05, 1, 0, 7, 0.828789189088421, 3.103800852904933,
                   0.002896815098522083}},
    RecordedTrial{"sobol",
                  "false",
                  11,
                  999,
                  {0.0006, 106.97064664450411, 833.821752497184, 148161.57689504637, 1.8041791251928307,
                   0.2805756747789015, 0.0003, 9.45e-05, 1, 1, 6, 0.933281376588421, 0.4379951124429402,
                   -0.0117995158303741}},
    RecordedTrial{"sobol",
                  "true",
                  5,
                  123,
                  {0.0006, 102.16689903087729, 603.3434711997465, 198672.42602388322, 0.6166241677898523,
                   0.28476171643411896, 0.0003, 3.85e-05, 0, 0, 22, 0.3898628018315099, 3.554523902208499,
                   -0.007732407514590065}},
    RecordedTrial{"sobol",
                  "true",
                  11,
                  999,
                  {0.0006, 103.07437343609088, 654.2352425616317, 230027.5299807256, 0.13207616787623336,
                   0.3208465229647221, 0.0003, 9.45e-05, 0, 1, 28, 0.265554847851707, 3.6807255806140335,
                   -0.0054889743628648395}},
};

TEST(RecordedTrials, InputsNeverChange) {
  for (const RecordedTrial& r : recorded) {
    const Study study = study_of(full_manifest(), {std::string("design=") + r.design,
                                                   std::string("independent_points=") + r.independent});
    EXPECT_EQ(study_trial(study, r.point, r.index).inputs, r.inputs)
        << r.design << " " << r.independent << " " << r.point << " " << r.index;
  }
}

std::vector<double> shipped_inputs(const char* name, std::int64_t point, std::int64_t index) {
  const auto path = std::filesystem::path(ZEROCOUNT_MANIFESTS) / (std::string(name) + ".yaml");
  return study_trial(manifest::load_study(path), point, index).inputs;
}

TEST(RecordedTrials, InputsOfShippedStudiesNeverChange) {
  using Inputs = std::vector<double>;
  EXPECT_EQ(shipped_inputs("creep", 1, 7), (Inputs{0.2108899526916283, 23.639586923168828, 1.5340186057656258,
                                                   0.035149372941878476, 0.0001}));
  EXPECT_EQ(shipped_inputs("k1-along-position", 1, 7),
            (Inputs{118.88763563827634, 6.5e-05, 28, 0.31842490501536896, 1.1268523423094954}));
  EXPECT_EQ(shipped_inputs("paper-fig7", 3, 7),
            (Inputs{95.47576209027036, 624.3800633036569, 4, 0.03333802305877931}));
  EXPECT_EQ(shipped_inputs("paper-fig8", 0, 7),
            (Inputs{111.80694861622081, 844.6662162896077, 0.7808370290590104, 11.063815572050062,
                    0.9881605140557418}));
  EXPECT_EQ(shipped_inputs("paper-gains", 3, 7),
            (Inputs{121.11823564271323, 113.50472154229266, 957.1078811449353, 88940.46226870158,
                    0.4125754549647488, 17.717219610312732, 1.9555178501386972, 0, 0.000208, 25,
                    0.3200862443096518, 5.357569270688762, 2.0090982157634843e-05, -0.0033703985796195712}));
  EXPECT_EQ(shipped_inputs("stability-map", 3, 7),
            (Inputs{119.39529652293292, 774.7119466374252, 0, 3.64112840605216e-05, 3, 0.5107224245775027}));
}

}  // namespace
}  // namespace zerocount::study

// The blocks of the controller in manifests: limits that are off, the short form of the deadband, sweeps.
#include "experiments/designs/designs.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

loop::ControllerParameters controller_of(const std::string& keys, std::int64_t point = 0) {
  return study::study_trial(study_of(minimal_manifest(keys)), point, 0).parameters.controller;
}

TEST(ControllerBlocks, AreOffByDefault) {
  const loop::ControllerParameters controller = controller_of("");
  for (const loop::ControlBlocks* blocks : {&controller.blocks, &controller.coarse.blocks}) {
    EXPECT_EQ(blocks->structure, loop::ControlStructure::pid);
    EXPECT_LT(blocks->deadband.enter, 0.0);
    EXPECT_LT(blocks->deadband.leave, 0.0);
    EXPECT_EQ(blocks->integrator_zone, unlimited);
    EXPECT_EQ(blocks->integrator_leak, unlimited);
    EXPECT_EQ(blocks->derivative_cutoff, unlimited);
    EXPECT_EQ(blocks->observer.bandwidth, 0.0);
  }
}

TEST(ControllerBlocks, EachPhaseHasItsOwnBlocks) {
  const loop::ControllerParameters controller = controller_of(
      "controller: {deadband: 1, observer: {bandwidth: 20, inertia: 5.0e-4}, coarse: {coarse_beyond: 300,\n"
      "  structure: cascade, cascade: {kv: 20, kp: 0.5, ki: 3}, deadband: {enter: 2, leave: 3}, "
      "integrator_leak: 0.5}}");
  EXPECT_EQ(controller.blocks.deadband.enter, 1.0);
  EXPECT_LT(controller.blocks.deadband.leave, 0.0);
  EXPECT_EQ(controller.blocks.observer.bandwidth, 20.0);
  EXPECT_EQ(controller.blocks.observer.inertia, 5e-4);
  EXPECT_EQ(controller.blocks.structure, loop::ControlStructure::pid);
  EXPECT_EQ(controller.coarse.blocks.structure, loop::ControlStructure::cascade);
  EXPECT_EQ(controller.coarse.blocks.cascade.kv, 20.0);
  EXPECT_EQ(controller.coarse.blocks.deadband.enter, 2.0);
  EXPECT_EQ(controller.coarse.blocks.deadband.leave, 3.0);
  EXPECT_EQ(controller.coarse.blocks.integrator_leak, 0.5);
}

TEST(ControllerBlocks, NoneSwitchesALimitOff) {
  const loop::ControllerParameters controller = controller_of(
      "controller: {deadband: none, integrator_zone: none, integrator_leak: none, derivative_cutoff: none, "
      "coarse: {coarse_beyond: none}}");
  EXPECT_LT(controller.blocks.deadband.enter, 0.0);
  EXPECT_EQ(controller.blocks.integrator_zone, unlimited);
  EXPECT_EQ(controller.blocks.integrator_leak, unlimited);
  EXPECT_EQ(controller.blocks.derivative_cutoff, unlimited);
  EXPECT_EQ(controller.coarse.coarse_beyond, unlimited);
  EXPECT_EQ(controller_of("controller: {deadband: {enter: 1, leave: none}}").blocks.deadband.enter, 1.0);
  EXPECT_EQ(controller_of("controller: {integrator_zone: 1.0e+12}").blocks.integrator_zone, unlimited);
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {kp: «none»}")),
                         "«»: controller.kp | is not a number"));
}

TEST(ControllerBlocks, DeadbandIsSweptAndDrawnInItsShortForm) {
  const study::Study study =
      study_of(minimal_manifest("sweep: {grid: {controller.deadband: [none, 0, 1.5]}}"));
  ASSERT_EQ(study::point_count(study), 3);
  EXPECT_EQ(study.points.labels[0], "controller.deadband=none");
  EXPECT_EQ(study.points.labels[2], "controller.deadband=1.5");
  EXPECT_EQ(study.points.axes.front().name, "controller.deadband.enter");
  const auto enter = [&](std::int64_t point) {
    return study::study_trial(study, point, 0).parameters.controller.blocks.deadband.enter;
  };
  EXPECT_LT(enter(0), 0.0);
  EXPECT_EQ(enter(1), 0.0);
  EXPECT_EQ(enter(2), 1.5);
  EXPECT_EQ(study_of(minimal_manifest("controller: {deadband: {uniform: [0, 2]}}")).columns.inputs[0].name,
            "controller.deadband.enter");
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {deadband: 1}\n"
                                                     "sweep: {grid: {controller.deadband: [1, 2], "
                                                     "«controller.deadband.enter»: [3]}}")),
                         "«»: sweep.grid.controller.deadband.enter | is swept twice"));
}

TEST(ControllerBlocks, AWrongKeyOfTheDeadbandIsRefusedWithItsKeys) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("controller: {deadband: {«entr»: 1}}")),
                         "«»: controller.deadband.entr | enter"));
}

// The parameters of a user's controller in manifests, without its library: a description is enough.

constexpr double without_limit = std::numeric_limits<double>::infinity();

PluginLoader two_parameters() {
  return known_plugin(std::make_shared<const plugin::ControllerPlugin>(
      plugin::ControllerPlugin{{"own",
                                "1",
                                "0123",
                                {{"gain", "N m/count", "a gain", 3.0, 0.0, 10.0},
                                 {"offset", "1", "any", 0.0, -without_limit, without_limit}}}}));
}

study::Study study_with_plugin(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return study_of(minimal_manifest(more), overrides, {.plugin = two_parameters()});
}

std::string refusal_with_plugin(const std::string& more, const PluginLoader& load = two_parameters()) {
  return refusal_of(minimal_manifest(more), {}, {.plugin = load});
}

const std::string own = "controller: {plugin: own.so, parameters: {gain: {uniform: [1, 5]}}}\n";

TEST(PluginParameters, HaveTheirDefaultsAndDistributions) {
  const study::Study study = study_with_plugin(own);
  const study::StudyTrial trial = study::study_trial(study, 0, 3);
  ASSERT_EQ(study.columns.inputs.size(), 1u);
  EXPECT_EQ(study.columns.inputs[0].name, "controller.parameters.gain");
  EXPECT_EQ(study.columns.inputs[0].unit, "N m/count");
  EXPECT_EQ(study.columns.inputs[0].meaning, "a gain");
  ASSERT_EQ(trial.parameters.controller.user.parameters.size(), 2u);
  EXPECT_EQ(trial.parameters.controller.user.parameters[0], trial.inputs[0]);
  EXPECT_EQ(trial.parameters.controller.user.parameters[1], 0.0);
  const study::Study without = study_with_plugin("controller: {plugin: own.so}\n");
  EXPECT_EQ(study::study_trial(without, 0, 0).parameters.controller.user.parameters,
            (std::vector<double>{3, 0}));
}

TEST(PluginParameters, AreSweptAndOverridden) {
  const study::Study study =
      study_with_plugin(own +
                            "sweep: {cases: {a: {controller.parameters.offset: -2}, b: {}}, grid: "
                            "{controller.parameters.gain: {linspace: [2, "
                            "4, 3]}}}\n",
                        {"controller.parameters.offset=7"});
  ASSERT_EQ(study::point_count(study), 6);
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.controller.user.parameters,
            (std::vector<double>{3, -2}));
  EXPECT_EQ(study::study_trial(study, 5, 0).parameters.controller.user.parameters,
            (std::vector<double>{4, 7}));
}

TEST(PluginParameters, AreDrawnForMachinesAndInEveryDesign) {
  EXPECT_EQ(
      study_with_plugin(own, {"machines=5", "trials=10"}).columns.shared[study::Grouping::machine].size(),
      1u);
  EXPECT_EQ(study_with_plugin(own, {"design=saltelli", "trials=9"}).factors,
            std::vector<std::string>{"controller.parameters.gain"});
  const study::Study sobol = study_with_plugin(own, {"design=sobol", "trials=8"});
  std::vector<double> gains;
  for (std::int64_t i = 0; i < 8; ++i) gains.push_back(study::study_trial(sobol, 0, i).inputs[0]);
  std::sort(gains.begin(), gains.end());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(static_cast<std::size_t>((gains[i] - 1) / 4 * 8), i);
}

TEST(PluginParameters, AnotherLibraryChangesTheHashOfTheStudy) {
  const auto sha_of = [](const char* sha256) {
    return manifest::parse_study(minimal_manifest("controller: {plugin: own.so}\n"), "m.yaml", {},
                                 {.plugin = known_plugin(std::make_shared<const plugin::ControllerPlugin>(
                                      plugin::ControllerPlugin{{"own", "1", sha256, {}}}))})
        .study_sha256;
  };
  EXPECT_EQ(sha_of("01"), sha_of("01"));
  EXPECT_NE(sha_of("01"), sha_of("02"));
}

TEST(PluginParameters, ErrorsNameThePlace) {
  const std::vector<std::pair<std::string, std::string>> refusals{
      {"controller: {plugin: own.so, parameters: {«gian»: 1}}", "«»: controller.parameters.gian | gain"},
      {"controller: {plugin: own.so, parameters: {gain: «11»}}",
       "«»: controller.parameters.gain | at least 0 and at most 10"},
      {"controller: {plugin: own.so, parameters: «3»}", "«»: controller.parameters | '3'"},
      {"controller: {parameters: «{gain: 1}»}", "«»: controller.parameters | controller.plugin"},
      {"controller: {plugin: own.so, kp: «1.0e-4»}", "«»: controller.kp | no effect | controller.parameters"},
      {"controller: {plugin: own.so, coarse: {coarse_beyond: «200»}}",
       "«»: controller.coarse.coarse_beyond | has no phases"},
      {"controller: {plugin: «[own.so]»}", "«»: controller.plugin | a list"},
      {"controller: {plugin: own.so}\nsweep: {grid: {«controller.parameters.gian»: [1]}}",
       "«»: sweep.grid.controller.parameters.gian | controller.parameters.gain"},
  };
  for (const auto& [text, message] : refusals) EXPECT_TRUE(has_faults(refusal_with_plugin(text), message));
  EXPECT_TRUE(has_faults(refusal_with_plugin("controller: {plugin: «own.so»}", {}),
                         "«»: controller.plugin | this command does not"));
}

TEST(PluginParameters, APluginCountsAsAController) {
  const std::string text =
      manifest_commanding("{torque: {levels: [0.1]}}", "controller: {plugin: «own.so»}\n");
  EXPECT_TRUE(has_faults(refusal_of(text, {}, {.plugin = two_parameters()}),
                         "«»: controller.plugin | no effect | command.targets"));
}

// Values in lists of the manifest other than that of the moves: elements of friction, and filters.

const std::string filters =
    "controller:\n"
    "  filters:\n"
    "    - notch: {frequency: 120, damping: {uniform: [0.3, 0.7]}, depth: 0.1}\n"
    "    - lowpass: {frequency: 400, damping: 0.7}\n"
    "    - lead: {frequency: 100, ratio: 4}\n"
    "    - biquad: {b: [1, 0.5, {uniform: [0, 0.1]}], a: [0.2, 0.3]}\n";

const std::string elements =
    "friction: {gms: {stiffness: [100, {uniform: [200, 300]}], weight: [0.4, 0.6]}}\n";

double drawn_uniform(const study::Study& study, const std::string& name, std::int64_t trial) {
  const random::RandomStream stream{designs::random_key(study.seed, name), 0};
  return random::open_uniform(
      random::random_bits(stream, static_cast<std::uint64_t>(trial), random::Draw::trial));
}

TEST(Lists, FiltersKeepTheOrderOfTheManifest) {
  const study::Study study = study_of(minimal_manifest(filters));
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  const std::vector<loop::Filter>& chain = trial.controller.blocks.filters;
  ASSERT_EQ(chain.size(), 4u);
  EXPECT_EQ(chain[0].kind, loop::FilterKind::notch);
  EXPECT_EQ(chain[0].frequency, 120);
  EXPECT_EQ(chain[0].depth, 0.1);
  EXPECT_EQ(chain[1].kind, loop::FilterKind::lowpass);
  EXPECT_EQ(chain[1].frequency, 400);
  EXPECT_EQ(chain[1].damping, 0.7);
  EXPECT_EQ(chain[2].kind, loop::FilterKind::lead);
  EXPECT_EQ(chain[2].ratio, 4);
  EXPECT_EQ(chain[3].kind, loop::FilterKind::biquad);
  EXPECT_EQ(chain[3].b[1], 0.5);
  EXPECT_EQ(chain[3].a, (std::array<double, 2>{0.2, 0.3}));
  EXPECT_TRUE(trial.controller.coarse.blocks.filters.empty());
}

TEST(Lists, TheCoarsePhaseHasItsOwnFilters) {
  const study::Study study = study_of(minimal_manifest(
      "controller: {filters: [{lead: {frequency: 100, ratio: 4}}],\n"
      "             coarse: {coarse_beyond: 200, filters: [{lowpass: {frequency: 50, damping: 1}}]}}\n"));
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  ASSERT_EQ(trial.controller.blocks.filters.size(), 1u);
  ASSERT_EQ(trial.controller.coarse.blocks.filters.size(), 1u);
  EXPECT_EQ(trial.controller.coarse.blocks.filters[0].frequency, 50);
}

TEST(Lists, ElementsHaveTheirStiffnessAndWeight) {
  const study::Study study = study_of(minimal_manifest(elements));
  const auto& gms = study::study_trial(study, 0, 3).parameters.friction.gms_elements;
  ASSERT_EQ(gms.size(), 2u);
  EXPECT_EQ(gms[0].stiffness, 100);
  EXPECT_EQ(gms[0].weight, 0.4);
  EXPECT_EQ(gms[1].weight, 0.6);
  EXPECT_EQ(gms[1].stiffness, 200 + 100 * drawn_uniform(study, "friction.gms.stiffness.1", 3));
}

// One warning for a list, not one for each of its values.
TEST(Lists, ElementsWithoutTheirModelGiveAWarning) {
  EXPECT_EQ(study_of(minimal_manifest(elements)).warnings.size(), 2u);
  EXPECT_TRUE(study_of(minimal_manifest(elements), {"friction.model=gms"}).warnings.empty());
}

TEST(Lists, DrawsDependOnTheNameOfTheElement) {
  const study::Study study = study_of(minimal_manifest(filters));
  ASSERT_EQ(study.columns.inputs.size(), 2u);
  EXPECT_EQ(study.columns.inputs[0].name, "controller.filters.0.damping");
  EXPECT_EQ(study.columns.inputs[1].name, "controller.filters.3.b.2");
  const study::StudyTrial trial = study::study_trial(study, 0, 5);
  const double damping = 0.3 + (0.7 - 0.3) * drawn_uniform(study, "controller.filters.0.damping", 5);
  EXPECT_DOUBLE_EQ(trial.inputs[0], damping);
  EXPECT_EQ(trial.parameters.controller.blocks.filters[0].damping, trial.inputs[0]);
  EXPECT_EQ(trial.parameters.controller.blocks.filters[3].b[2], trial.inputs[1]);
}

TEST(Lists, WithMachinesElementsAreDrawnPerMachine) {
  const study::Study study = study_of(minimal_manifest(filters), {"machines=5", "trials=10"});
  ASSERT_EQ(study.columns.shared[study::Grouping::machine].size(), 2u);
  EXPECT_EQ(study::study_trial(study, 0, 2).inputs, study::study_trial(study, 0, 7).inputs);
  EXPECT_NE(study::study_trial(study, 0, 2).inputs, study::study_trial(study, 0, 3).inputs);
}

TEST(Lists, EveryDesignStratifiesElements) {
  for (const char* design : {"design=latin_hypercube", "design=sobol"}) {
    const study::Study study = study_of(minimal_manifest(filters), {design, "trials=16"});
    std::set<int> strata;
    for (std::int64_t i = 0; i < 16; ++i)
      strata.insert(static_cast<int>((study::study_trial(study, 0, i).inputs[1]) / 0.1 * 16));
    EXPECT_EQ(strata.size(), 16u) << design;
  }
  const study::Study saltelli = study_of(minimal_manifest(filters), {"design=saltelli", "trials=8"});
  EXPECT_EQ(saltelli.factors,
            (std::vector<std::string>{"controller.filters.0.damping", "controller.filters.3.b.2"}));
}

TEST(Lists, ElementsAreSweptOneByOneOrAsAList) {
  const study::Study study = study_of(
      minimal_manifest(filters + elements +
                       "sweep:\n"
                       "  cases: {a: {controller.filters.0.depth: 1}, b: {friction.gms.weight: [0.5, 0.5]}}\n"
                       "  grid: {controller.filters.1.frequency: {linspace: [100, 200, 2]},\n"
                       "         controller.filters.3.a: [[0, 0], [0.1, 0.2]]}\n"));
  ASSERT_EQ(study::point_count(study), 8);
  EXPECT_EQ(study.points.labels[7],
            "b, controller.filters.1.frequency=200, controller.filters.3.a=[0.1, 0.2]");
  const trial::TrialParameters last = study::study_trial(study, 7, 0).parameters;
  EXPECT_EQ(last.controller.blocks.filters[0].depth, 0.1);
  EXPECT_EQ(last.controller.blocks.filters[1].frequency, 200);
  EXPECT_EQ(last.controller.blocks.filters[3].a, (std::array<double, 2>{0.1, 0.2}));
  EXPECT_EQ(last.friction.gms_elements[0].weight, 0.5);
  const trial::TrialParameters first = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(first.controller.blocks.filters[0].depth, 1);
  EXPECT_EQ(first.controller.blocks.filters[3].a, (std::array<double, 2>{0, 0}));
  EXPECT_EQ(first.friction.gms_elements[0].weight, 0.4);
}

TEST(Lists, OverridesNameElements) {
  const study::Study study =
      study_of(minimal_manifest(filters + elements),
               {"controller.filters.0.frequency=130", "controller.filters.1.lowpass.damping=0.9",
                "controller.filters.3.b.0=2", "controller.filters.3.a=[0.4, 0.5]",
                "friction.gms.weight.0=0.3", "friction.gms.weight.1=0.7"});
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(trial.controller.blocks.filters[0].frequency, 130);
  EXPECT_EQ(trial.controller.blocks.filters[1].damping, 0.9);
  EXPECT_EQ(trial.controller.blocks.filters[3].b[0], 2);
  EXPECT_EQ(trial.controller.blocks.filters[3].a, (std::array<double, 2>{0.4, 0.5}));
  EXPECT_EQ(trial.friction.gms_elements[1].weight, 0.7);
}

// A list changes nothing else: not the draws, not the order of the columns.
TEST(Lists, ListsDoNotChangeOtherDraws) {
  const std::string drawn = "plant: {inertia: {uniform: [1.0e-4, 2.0e-4]}}\n";
  const std::string start = "initial: {encoder_phase: {uniform: [0, 1]}}\n";
  const study::Study without = study_of(minimal_manifest(drawn + start), {"design=sobol"});
  const study::Study with = study_of(minimal_manifest(drawn + filters + elements + start), {"design=sobol"});
  for (std::int64_t i = 0; i < 4; ++i) {
    const std::vector<double> inputs = study::study_trial(with, 0, i).inputs;
    ASSERT_EQ(inputs.size(), 5u);
    EXPECT_EQ(study::study_trial(without, 0, i).inputs, (std::vector<double>{inputs[0], inputs[4]}));
  }
}

TEST(Lists, ParameterListingIncludesElements) {
  std::set<std::string> names;
  for (const manifest::ListedParameter& row :
       manifest::listed_parameters(study_of(minimal_manifest(filters + elements))))
    names.insert(row.name);
  for (const char* name : {"controller.filters.0.frequency", "controller.filters.3.b.2",
                           "friction.gms.stiffness.1", "command.targets.0", "friction.k1"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_FALSE(names.contains("controller.filters.0.ratio"));
  for (const std::string& name : names) EXPECT_EQ(name.find('#'), std::string::npos) << name;
}

struct Refusal {
  const char* line;
  const char* message;
};

TEST(Lists, ErrorsNameThePlace) {
  const std::vector<Refusal> refusals{
      {"controller: {filters: «3»}", "«»: controller.filters | '3'"},
      {"controller: {filters: [{«nocth»: {}}]}", "«»: controller.filters.0.nocth | unknown filter"},
      {"controller: {filters: [«{}»]}", "«»: controller.filters.0 | map with 0 keys"},
      {"controller: {filters: [{lead: «{frequency: 10}»}]}", "«»: controller.filters.0.lead.ratio | missing"},
      {"controller: {filters: [{lead: {frequency: 10, ratio: «-1»}}]}",
       "«»: controller.filters.0.lead.ratio | greater than 0"},
      {"controller: {filters: [{biquad: {b: «[1, 2]», a: [0, 0]}}]}",
       "«»: controller.filters.0.biquad.b | list of 2"},
      {"controller: {filters: [{lead: {frequency: «{uniform: [10, 1000]}», ratio: 4}}]}",
       "«»: controller.filters.0.frequency | half the sample rate"},
      {"controller: {filters: [{lead: {frequency: 10, ratio: {profile: «{mean: 1, cv: 0.1, "
       "correlation_length: "
       "1}»}}}]}",
       "«»: controller.filters.0.lead.ratio.profile | along the rotor"},
      {"friction: {gms: {stiffness: [«1», 2], weight: [1]}}", "«»: friction.gms.stiffness.0 | 2 stiffnesses"},
      {"friction: {gms: {stiffness: [1, 2], weight: [«0.5», 0.4]}}", "«»: friction.gms.weight.0 | 0.9"},
      {"sweep: {grid: {«controller.filters.0.frequency»: [1]}}",
       "«»: sweep.grid.controller.filters.0.frequency | the study has no"},
      {"sweep: {grid: {«friction.gms.weight.0»: [1]}}",
       "«»: sweep.grid.friction.gms.weight.0 | the study has no"},
      {"sweep: {grid: {«controller.filters»: [[]]}}", "«»: sweep.grid.controller.filters | cannot be swept"},
  };
  for (const Refusal& refusal : refusals)
    EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(refusal.line)), refusal.message));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("controller: {filters: [{lead: {frequency: 10, ratio: 4}}]}\n"
                                             "sweep: {grid: {«controller.filters.0.depth»: [1]}}")),
                 "«»: sweep.grid.controller.filters.0.depth | the study has no"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(filters), {"controller.filters.1.depth=1"}),
                         "--set controller.filters.1.depth=1: controller.filters.1.depth | 'depth'"));
}

}  // namespace
}  // namespace zerocount::sections

// Values in lists of the manifest other than that of the moves: elements of friction, and filters.
#include "experiments/designs/random_key.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "experiments/study/plan.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

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

TEST(Lists, FiltersAreThoseOfTheManifestInItsOrder) {
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
TEST(Lists, ElementsWithoutTheirModelAreWarnedOf) {
  EXPECT_EQ(study_of(minimal_manifest(elements)).warnings.size(), 2u);
  EXPECT_TRUE(study_of(minimal_manifest(elements), {"friction.model=gms"}).warnings.empty());
}

TEST(Lists, ValuesAreDrawnByTheirNames) {
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

TEST(Lists, WithRigsTheirValuesBelongToTheRig) {
  const study::Study study = study_of(minimal_manifest(filters), {"rigs=5", "trials=10"});
  ASSERT_EQ(study.columns.rigs.size(), 2u);
  EXPECT_EQ(study::study_trial(study, 0, 2).inputs, study::study_trial(study, 0, 7).inputs);
  EXPECT_NE(study::study_trial(study, 0, 2).inputs, study::study_trial(study, 0, 3).inputs);
}

TEST(Lists, EveryDesignSpreadsTheirValues) {
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

TEST(Lists, ValuesAreSweptOneByOneOrAsAList) {
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

TEST(Lists, OverridesUseTheNamesOfTheParameters) {
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
TEST(Lists, OtherDrawsStayAsTheyAre) {
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

TEST(Lists, AListingOfTheStudyHasThem) {
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
      {"controller: {filters: 3}", "6:23: controller.filters | '3'"},
      {"controller: {filters: [{nocth: {}}]}", "6:25: controller.filters.0.nocth | unknown filter"},
      {"controller: {filters: [{}]}", "6:24: controller.filters.0 | map with 0 keys"},
      {"controller: {filters: [{lead: {frequency: 10}}]}", "6:31: controller.filters.0.lead.ratio | missing"},
      {"controller: {filters: [{lead: {frequency: 10, ratio: -1}}]}",
       "6:54: controller.filters.0.lead.ratio | greater than 0"},
      {"controller: {filters: [{biquad: {b: [1, 2], a: [0, 0]}}]}",
       "6:37: controller.filters.0.biquad.b | list of 2"},
      {"controller: {filters: [{lead: {frequency: {uniform: [10, 1000]}, ratio: 4}}]}",
       "6:43: controller.filters.0.frequency | half the sample rate"},
      {"controller: {filters: [{lead: {frequency: 10, ratio: {profile: {mean: 1, cv: 0.1, "
       "correlation_length: "
       "1}}}}]}",
       "6:64: controller.filters.0.lead.ratio.profile | along the rotor"},
      {"friction: {gms: {stiffness: [1, 2], weight: [1]}}", "6:30: friction.gms.stiffness.0 | 2 stiffnesses"},
      {"friction: {gms: {stiffness: [1, 2], weight: [0.5, 0.4]}}", "6:46: friction.gms.weight.0 | 0.9"},
      {"sweep: {grid: {controller.filters.0.frequency: [1]}}",
       "6:16: sweep.grid.controller.filters.0.frequency | the study has no"},
      {"sweep: {grid: {friction.gms.weight.0: [1]}}",
       "6:16: sweep.grid.friction.gms.weight.0 | the study has no"},
      {"sweep: {grid: {controller.filters: [[]]}}", "6:16: sweep.grid.controller.filters | cannot be swept"},
  };
  for (const Refusal& refusal : refusals)
    EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(refusal.line)), refusal.message));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("controller: {filters: [{lead: {frequency: 10, ratio: 4}}]}\n"
                                             "sweep: {grid: {controller.filters.0.depth: [1]}}")),
                 "7:16: sweep.grid.controller.filters.0.depth | the study has no"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(filters), {"controller.filters.1.depth=1"}),
                         "--set controller.filters.1.depth=1: controller.filters.1.depth | 'depth'"));
}

}  // namespace
}  // namespace zerocount::sections

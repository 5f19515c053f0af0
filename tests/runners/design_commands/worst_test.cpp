// `worst`: the manifest of the worst machine repeats its trials, and no machine of the study is worse.

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/plan.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "tests/runners/design_commands/tune_fixture.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

constexpr std::string_view common_part = R"(zerocount: 1
name: worst
seed: 3
command: {targets: [12], hold: 0.09}
initial: {encoder_phase: {uniform: [0, 1]}, preload: {uniform: [-0.1, 0.1]}}
controller: {ki: 6.0e-5}
)";

class Worst : public ProgramTest {
 protected:
  Json worst(const std::string& manifest, const std::vector<std::string>& more = {}) {
    folder_.write("axis.yaml", manifest);
    std::vector<std::string> words{"worst", "axis.yaml", "-o", "worst.yaml", "--force", "--format", "json"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err << manifest;
    return result.code == 0 ? Json::parse(result.out) : Json();
  }

  /// Proportion of the moves of a machine that meet the goal when the manifest `worst.yaml` is run.
  double replayed(std::int64_t machine) {
    const ProgramResult run = program({"run", "worst.yaml", "-o", "worst.h5", "--force", "--quiet"});
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_FALSE(says(run.err, "worlds")) << "nothing differs between worlds: " << run.err;
    const reading::AllTrialsFile file(folder_.path() / "worst.h5");
    const study::Study study = layout::recorded_study(file.header(), "worst.h5");
    trials::Replicates units = trials::replicates_of(study, 0);
    if (study.machines == 0) units = {1, study.trials, 0};
    const auto results = tuning::results_in(file, study, units);
    return met_proportion(
        results[static_cast<std::size_t>(study.machines == 0 ? 0 : machine)].claims.front());
  }
};

TEST_F(Worst, ItsManifestReproducesIt) {
  folder_.write(
      "machines.csv",
      "friction.k1,friction.k2,initial.preload\n100,700,0.05\n100,900,-0.05\n140,700,0.1\n90,500,0\n");
  const std::string goal = "goal: {band: 0, within: 0.045, moves: 0.9}\n";
  const std::string machines =
      "goal: {band: 0, within: 0.045, moves: 0.9, machines: 0.8}\nmachines: 6\ntrials: 24\n";
  const std::string k1_per_machine = "friction: {k1: {lognormal: {median: 130, cv: 0.2}, per: machine}";
  struct Case {
    const char* what;
    std::string more;
    std::vector<std::string> words{};
  };
  const std::vector<Case> cases{
      {"rows",
       goal + "machines: 6\ntrials: 24\nsamples: {file: machines.csv, per: machine}\nfriction: {alpha: "
              "{uniform: "
              "[0.1, 1]}}\n",
       {"--set", "initial={encoder_phase: {uniform: [0, 1]}}"}},
      {"worlds", machines + "worlds: 3\n" + k1_per_machine + ", n: {uniform: [1.5, 2.5], per: world}}\n"},
      {"a profile", goal + "trials: 24\nfriction: {k1: {profile: {mean: {uniform: [100, 140]}, cv: 0.2, "
                           "correlation_length: 1}}, "
                           "k2: {uniform: [500, 900]}}\ndesign: latin_hypercube\n"},
      {"contacts", machines + k1_per_machine + ", breakaway: {uniform: [0.25, 0.35], per: contact}}\n"},
      {"correlation",
       goal + "trials: 30\ndesign: sobol\nfriction: {k1: {uniform: [90, 150]}, k2: {uniform: [500, 900]}}\n"
              "correlation: [[friction.k1, friction.k2, 0.6], [friction.k2, initial.preload, 0.3]]\n"},
      {"a sweep",
       goal + "trials: 30\nsweep: {cases: {a: {friction.k1: 120}, b: {friction.k1: {uniform: [80, 110]}, "
              "initial.preload: {uniform: [0, 0.2]}}}, grid: {controller.kp: {linspace: [0, 2.0e-4, 3]}}}\n",
       {"--point", "5"}},
      {"a filter",
       goal + "trials: 30\n",
       {"--set",
        "controller.filters=[{notch: {frequency: {uniform: [300, 600]}, "
        "damping: 0.5, depth: 0.2}}]",
        "--set", "controller.deadband={uniform: [0, 2]}"}},
  };
  for (const Case& one : cases) {
    const Json found = worst(std::string(common_part) + one.more, one.words);
    ASSERT_FALSE(found.is_null()) << one.what;
    const Json box = found["box"];
    EXPECT_DOUBLE_EQ(replayed(box["machine"]), box["met"]) << one.what;
    EXPECT_EQ(program({"trace", "worst.yaml", "--trial", box["trial"].dump()}).code, 0) << one.what;
  }
}

// Another design draws another mean; the profile is that of the study.
TEST_F(Worst, KeepsTheProfileOfTheStudyInEveryDesign) {
  for (const char* design : {"monte_carlo", "sobol", "latin_hypercube"}) {
    const Json found = worst(fmt::format(
        "{}goal: {{band: 0, within: 0.045, moves: 0.9}}\ntrials: 8\ndesign: {}\nfriction: {{k1: {{profile: "
        "{{mean: "
        "{{uniform: [100, 140]}}, cv: 0.2, correlation_length: 1}}}}, k2: {{uniform: [500, 900]}}}}\n",
        common_part, design));
    const study::Study study = manifest::load_study(folder_.path() / "worst.yaml");
    EXPECT_DOUBLE_EQ(study.plan->profiles.front()->mean(0), found["inputs"]["friction.k1.profile.mean"])
        << design;
  }
}

// The search begins at the machines of the study: what it finds is at least as bad, by the same trials.
TEST_F(Worst, IsAtLeastAsBadAsTheWorstMachineOfTheStudy) {
  const std::string machines =
      std::string(common_part) +
      "goal: {band: 0, within: 0.05, moves: 0.9}\nmachines: 30\ntrials: 60\nfriction: "
      "{k1: {lognormal: {median: 130, cv: 0.4}, per: machine}, beta: {log_uniform: "
      "[3.0e+4, 3.0e+5], per: machine}}\n";
  const Json found = worst(machines);
  EXPECT_LE(found["box"]["met"], found["again"]["met"]) << found;
  EXPECT_EQ(found["box"]["moves"], found["again"]["moves"]);
}

TEST_F(Worst, NamesTheWorstLikelyMachineToo) {
  folder_.write("axis.yaml",
                std::string(common_part) +
                    "goal: {band: 0, within: 0.05, moves: 0.9}\ntrials: 20\nsamples: rows.csv\n");
  folder_.write("rows.csv", "friction.k1,friction.k2\n100,700\n140,900\n90,500\n");
  const ProgramResult text = program({"worst", "axis.yaml"});
  EXPECT_TRUE(says(text.out, "also of the likely machines"));
  const Json json = Json::parse(program({"worst", "axis.yaml", "--format", "json"}).out);
  EXPECT_EQ(json["likely"]["in_box"], true);
  EXPECT_EQ(json["likely"]["inputs"], json["box"]["inputs"]);
}

// Only the correlation of its values makes a draw a machine: in the corners of the box there is none.
TEST_F(Worst, IsAPossibleMachineIfMeasuredValuesDependOnEachOther) {
  const std::string manifest =
      std::string(common_part) +
      "machines: 8\ntrials: 16\ngoal: {band: 1, within: 0.05, moves: 0.9}\n"
      "friction: {measured: {initial_stiffness: 1500, final_stiffness: {log_uniform: "
      "[20, 800]}, breakaway: {log_uniform: [0.2, 2.4]}, breakaway_travel: 2.0e-3}}\n"
      "correlation: [[friction.measured.final_stiffness, friction.measured.breakaway, "
      "0.9999]]\n";
  const Json found = worst(manifest);
  EXPECT_EQ(program({"check", "worst.yaml"}).code, 0) << found;
  folder_.write("independent.yaml", manifest.substr(0, manifest.find("correlation")));
  const ProgramResult run = program(
      {"run", "independent.yaml", "-o", "independent.h5", "--set", "machines=80", "--set", "trials=80"});
  EXPECT_EQ(run.code, 2) << run.err;
  EXPECT_TRUE(says(run.err, "friction.measured.final_stiffness: machine "));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "independent.h5"));
}

// Rows that are drawn for each trial do not belong to a machine with machines, and a results file has no
// place of their table.
TEST_F(Worst, AnswersEvenIfNoManifestDescribesIt) {
  folder_.write("rows.csv", "initial.preload,initial.velocity\n0,0\n0.1,0\n0.05,0\n");
  const std::string manifest =
      "zerocount: 1\nname: rows\nseed: 3\nmachines: 4\ntrials: 8\nsamples: {file: rows.csv, per: trial}\n"
      "friction: {k1: {uniform: [90, 150], per: machine}}\ncommand: {targets: [12], hold: 0.09}\n"
      "goal: {band: 0, within: 0.05, moves: 0.9}\n";
  const Json found = worst(manifest);
  EXPECT_DOUBLE_EQ(replayed(0), found["box"]["met"]);
  ASSERT_EQ(program({"run", "axis.yaml", "-o", "rows.h5", "--quiet"}).code, 0);
  const ProgramResult result = program({"worst", "rows.h5", "-o", "w.yaml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(result.out, "worst in the box")) << "the answer is printed";
  EXPECT_TRUE(says(result.err, "no manifest describes the worst machine"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "w.yaml"));
}

constexpr std::string_view aging_axis = R"(machines: 8
trials: 32
ages: {at: [0, 1.0e+6]}
conditions: {warm: {}, cold: {plant.presliding_damping: 0.3}}
friction: {k1: {lognormal: {median: 130, cv: 0.2}, aging: {exponential: {normal: {mean: 0.4, sd: 0.1}}, scale: 1.0e+6}}}
goal: {band: 1, within: 0.06, moves: 0.9}
)";

TEST_F(Worst, IsSoughtAtOneAge) {
  folder_.write("aging.yaml", std::string(common_part) + std::string(aging_axis));
  const ProgramResult all = program({"worst", "aging.yaml", "--format", "json"});
  ASSERT_EQ(all.code, 0) << all.err;
  const ProgramResult one = program(
      {"worst", "aging.yaml", "--age", "1e6", "--condition", "cold", "--format", "json", "-o", "w.yaml"});
  ASSERT_EQ(one.code, 0) << one.err;
  const Json found = Json::parse(one.out);
  EXPECT_EQ(found["condition"], "cold, 1000000 cycles");
  // Trials of the last condition and age, of the whole study.
  EXPECT_GE(found["trial"].get<int>() / 8 % 4, 3);
  EXPECT_LE(Json::parse(all.out)["box"]["met"], found["box"]["met"]);
  EXPECT_EQ(program({"limits", "aging.yaml", "--age", "2"}).code, 2);
}

TEST_F(Worst, RefusesAManifestBeforeTheSearch) {
  folder_.write("aging.yaml",
                std::string(common_part) + std::string(aging_axis) +
                    "plant: {sliding_damping: {uniform: [1.0e-3, 2.0e-3], per: study, aging: {linear: 0.1, "
                    "scale: 1.0e+6}}}\n");
  const ProgramResult refused = program({"worst", "aging.yaml", "-o", "w.yaml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(says(refused.err, "plant.sliding_damping changes with age, and is drawn per study"));
}

class WorstOfAxis : public Tune {};

// Stiffness alone decides, and more of it is worse: the worst machine is at the end of the box.
TEST_F(WorstOfAxis, IsFoundAtTheEndOfTheBox) {
  folder_.write("soft.yaml", R"(zerocount: 1
name: soft
seed: 3
trials: 40
command: {targets: [20], hold: 0.2}
friction: {model: spring, k1: {uniform: [100, 140]}, k2: 0}
initial: {encoder_phase: {uniform: [0, 1]}}
controller: {ki: 3.0e-5}
goal: {band: 0, within: 0.06, moves: 0.9}
)");
  const Json box = Json::parse(program({"worst", "soft.yaml", "--format", "json"}).out)["box"];
  const double quantile = box["quantiles"][0];
  EXPECT_TRUE(quantile < 0.01 || quantile > 0.99) << quantile;
}

TEST_F(WorstOfAxis, IsTheMachineWithTheFewestGoodMoves) {
  write_axis("goal: {band: 0, within: 0.05, moves: 0.98}\n");
  ASSERT_EQ(program({"run", "axis.yaml", "-o", "out.h5"}).code, 0);
  const Json of_manifest = Json::parse(program({"worst", "axis.yaml", "--format", "json"}).out);
  const Json of_file = Json::parse(program({"worst", "out.h5", "--format", "json"}).out);
  EXPECT_EQ(of_manifest, of_file);
  const Json box = of_manifest["box"];
  EXPECT_LE(box["met"], of_manifest["met"].get<double>() + 0.1) << "the box has the sampled machines' ranges";
  for (const double quantile : box["quantiles"]) {
    EXPECT_GE(quantile, 0.0005);
    EXPECT_LE(quantile, 0.9995);
  }
  const ProgramResult set = program({"worst", "out.h5", "--set", "controller.delay=0"});
  EXPECT_EQ(set.code, 2);
  EXPECT_TRUE(says(set.err, "changes a manifest"));
  EXPECT_LT(of_manifest["machine"], 100);
  EXPECT_GT(of_manifest["inputs"]["friction.k1"], 0.0);
}

}  // namespace
}  // namespace zerocount::testing

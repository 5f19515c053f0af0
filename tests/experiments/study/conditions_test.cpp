// `conditions` in a manifest: each machine bears all of them on the same draws, and what is refused.
#include "core/trial/trial.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

/// An override by a condition, and the overrides of `--set` that have the same effect on the manifest.
struct Override {
  std::string in_condition;
  std::vector<std::string> in_manifest;
};

const std::vector<Override>& override_pool() {
  static const std::vector<Override> pool{
      {"plant.inertia: 7.0e-4", {"plant.inertia=7.0e-4"}},
      {"controller.delay: {uniform: [0.5, 1.5]}", {"controller.delay={uniform: [0.5, 1.5]}"}},
      {"friction.k2: {uniform: [100, 200]}", {"friction.k2={uniform: [100, 200]}"}},
      {"friction.k2: 321", {"friction.k2=321"}},
      {"friction.lambda: {log_uniform: [2, 4]}",  // drawn as often as its parameter
       {"friction.lambda={log_uniform: [2, 4], per: trial}"}},
      {"friction.beta: {uniform: [1.0e5, 1.1e5]}", {"friction.beta={uniform: [1.0e5, 1.1e5], per: contact}"}},
      {"friction.alpha: {uniform: [1, 2]}", {"friction.alpha={uniform: [1, 2], per: study}"}},
      {"friction.k1: {profile: {mean: 90, cv: 0.2, correlation_length: 0.5}}",
       {"friction.k1={profile: {mean: 90, cv: 0.2, correlation_length: 0.5}}"}},
      {"friction.k1: 130", {"friction.k1=130"}},
      {"encoder.fine: {integers: [500000, 600000]}", {"encoder.fine={integers: [500000, 600000]}"}},
      {"command.targets.1: {integers: [-9, 9]}", {"command.targets.1={integers: [-9, 9]}"}},
      {"command.targets: [4, {integers: [1, 3]}]", {"command.targets=[4, {integers: [1, 3]}]"}},
      {"initial.position: 2", {"initial.position=2"}},
      {"encoder.fine_errors.noise: 0.2", {"encoder.fine_errors.noise=0.2"}}};
  return pool;
}

const std::string machines =
    "friction:\n"
    "  k1: {profile: {mean: {lognormal: {median: 110, cv: 0.1}}, cv: 0.1, correlation_length: 0.3}}\n"
    "  k2: {uniform: [600, 900]}\n"
    "  lambda: {uniform: [5, 20], per: trial}\n"
    "  alpha: {uniform: [0.1, 0.9], per: study}\n"
    "  beta: {uniform: [1.0e5, 2.0e5], per: contact}\n"
    "encoder: {fine: {integers: [1000000, 2000000]}, fine_errors: {noise: 0.1}}\n"
    "initial: {position: {uniform: [0, 6]}, hardening: {uniform: [0, 1.0e-6]}}\n"
    "sweep: {grid: {controller.ki: [3.0e-5, 4.0e-5]}}\n";

std::string manifest_with(const std::string& more) {
  return "zerocount: 1\nname: c\nseed: 5\ntrials: 24\n"
         "command: {targets: [{integers: [1, 9]}, 2], hold: 0.004}\n"
         "verdict: {dwell: 0.001, window: 0.001}\n" +
         machines + more;
}

/// Random indices of `count` different overrides that can be combined.
std::vector<std::size_t> some_overrides(std::uint64_t& state, std::size_t count) {
  std::vector<std::size_t> chosen;
  std::set<std::string> keys;
  while (chosen.size() < count) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const std::size_t one = (state >> 33U) % override_pool().size();
    const std::string& text = override_pool()[one].in_condition;
    std::string key = text.substr(0, text.find(':'));
    if (key.starts_with("command.targets")) key = "command.targets";
    if (keys.insert(key).second) chosen.push_back(one);
  }
  return chosen;
}

std::string text_of(const std::vector<std::size_t>& overrides) {
  std::string text;
  for (const std::size_t one : overrides)
    text += (text.empty() ? "" : ", ") + override_pool()[one].in_condition;
  return "{" + text + "}";
}

/// Text of the numbers, some of which may be NaN, with all digits.
std::string text_of(const std::vector<double>& numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

void expect_equal_runs(const StudyTrial& a, const StudyTrial& b) {
  EXPECT_EQ(a.target_positions, b.target_positions);
  EXPECT_EQ(a.parameters.command.targets, b.parameters.command.targets);
  EXPECT_EQ(a.parameters.plant.inertia, b.parameters.plant.inertia);
  EXPECT_EQ(a.parameters.randomness.trial, b.parameters.randomness.trial);
  EXPECT_EQ(a.parameters.randomness.stream, b.parameters.randomness.stream);
  const trial::TrialOutcome x = trial::run_trial(a.parameters);
  const trial::TrialOutcome y = trial::run_trial(b.parameters);
  ASSERT_EQ(x.moves.size(), y.moves.size());
  for (std::size_t move = 0; move < x.moves.size(); ++move) {
    EXPECT_EQ(x.moves[move].final_position, y.moves[move].final_position);
    EXPECT_EQ(x.moves[move].creep, y.moves[move].creep);
    EXPECT_EQ(x.moves[move].holding_torque, y.moves[move].holding_torque);
  }
}

// The definition: trial i is trial j of the study in which the overrides stand in the manifest.
TEST(Conditions, ATrialEqualsThatOfTheStudyWithTheOverrides) {
  std::uint64_t state = 1;
  int seed = 0;
  for (const std::string design : {"monte_carlo", "latin_hypercube", "sobol"}) {
    for (const int machines : {0, 4}) {
      for (const int worlds : {0, 2}) {
        for (const int conditions : {1, 2, 3}) {
          std::vector<std::vector<std::size_t>> overrides;
          std::string section = "conditions: {";
          for (int c = 0; c < conditions; ++c) {
            overrides.push_back(some_overrides(state, static_cast<std::size_t>(c)));
            section += fmt::format("{}c{}: {}", c == 0 ? "" : ", ", c, text_of(overrides.back()));
          }
          std::vector<std::string> settings{"design=" + design, fmt::format("seed={}", ++seed),
                                            fmt::format("independent_points={}", seed % 2 == 0)};
          if (machines > 0) settings.push_back(fmt::format("machines={}", machines));
          if (worlds > 0) {
            settings.push_back(fmt::format("worlds={}", worlds));
            settings.emplace_back("plant.presliding_damping={interval: [0.1, 0.3]}");
          }
          const Study study = study_of(manifest_with(section + "}\n"), settings);
          ASSERT_EQ(study.settings.total(), std::max<std::int64_t>(conditions, 1));
          for (int c = 0; c < conditions; ++c) {
            std::vector<std::string> alone = settings;
            alone.push_back(fmt::format("trials={}", 24 / conditions));
            for (const std::size_t one : overrides[static_cast<std::size_t>(c)])
              for (const std::string& set : override_pool()[one].in_manifest) alone.push_back(set);
            const Study other = study_of(manifest_with(""), alone);
            const Study part = in_setting(study, c);
            EXPECT_EQ(part.trials, other.trials);
            std::set<std::int64_t> draws;
            for (std::int64_t i = 0; i < study.trials; ++i) {
              const std::int64_t r = machines > 0 ? machines : 1;
              if (i / r % conditions != c) continue;
              const std::int64_t j = i % r + r * (i / (r * conditions));
              draws.insert(j);
              EXPECT_EQ(trial_indices(study).trial_of(j, c), i);
              if (worlds > 0) {
                EXPECT_EQ(group_of(study, Grouping::world, i), group_of(other, Grouping::world, j));
              }
              for (std::int64_t point = 0; point < 2; ++point) {
                const StudyTrial trial = study_trial(study, point, i);
                const StudyTrial expected = study_trial(other, point, j);
                const StudyTrial of_part = study_trial(part, point, j);
                EXPECT_EQ(text_of(of_part.inputs), text_of(trial.inputs));
                EXPECT_EQ(of_part.parameters.randomness.stream, trial.parameters.randomness.stream);
                for (std::size_t column = 0; column < study.columns.inputs.size(); ++column) {
                  for (std::size_t k = 0; k < other.columns.inputs.size(); ++k) {
                    if (study.columns.inputs[column].name == other.columns.inputs[k].name) {
                      EXPECT_EQ(trial.inputs[column], expected.inputs[k])
                          << study.columns.inputs[column].name << " " << section;
                    }
                  }
                }
                expect_equal_runs(trial, expected);
              }
            }
            EXPECT_EQ(std::ssize(draws), other.trials);
          }
        }
      }
    }
  }
}

/// The values of one machine or world, by the names of their columns.
std::map<std::string, double> values_of(const std::vector<InputColumn>& columns,
                                        const std::vector<double>& values) {
  std::map<std::string, double> by_name;
  EXPECT_EQ(columns.size(), values.size());
  for (std::size_t i = 0; i < columns.size(); ++i) by_name[columns[i].name] = values[i];
  return by_name;
}

// What is overridden stands once for each condition, and all else once.
TEST(Conditions, MachinesAndWorldsListOverriddenValuesPerCondition) {
  const std::string machine =
      "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}, lambda: 5}\n"
      "encoder: {fine: 1000000}\n"
      "plant: {inertia: {uniform: [5.0e-4, 6.0e-4], per: world}, "
      "sliding_damping: {uniform: [0.1, 0.2], per: world}}\n";
  const std::string text =
      "zerocount: 1\nname: c\nseed: 5\nworlds: 3\nmachines: 6\ntrials: 36\n" + machine +
      "command: {targets: [4], hold: 0.1}\ninitial: {position: {uniform: [0, 6]}}\n"
      "conditions: {bare: {}, loaded: {plant.inertia: {uniform: [7.0e-4, 8.0e-4]}, friction.k2: 321, "
      "friction.lambda: {uniform: [2, 4]}}}\n";
  const Study study = study_of(text);
  for (std::int64_t c = 0; c < 2; ++c) {
    const Study part = in_setting(study, c);
    const std::string place = "@" + label_of(study.settings, c);
    const std::set<std::string> overridden{"friction.k2", "friction.lambda", "plant.inertia"};
    for (std::int64_t machine = 0; machine < study.machines; ++machine) {
      const StudyTrial trial = study_trial(study, 0, trial_indices(study).trial_of(machine, c));
      const std::int64_t world = machine % study.worlds;
      const auto of_machine =
          values_of(study.columns.shared[Grouping::machine], group_inputs(study, Grouping::machine, machine));
      const auto of_world =
          values_of(study.columns.shared[Grouping::world], group_inputs(study, Grouping::world, world));
      const auto machine_of_part =
          values_of(part.columns.shared[Grouping::machine], group_inputs(part, Grouping::machine, machine));
      const auto world_of_part =
          values_of(part.columns.shared[Grouping::world], group_inputs(part, Grouping::world, world));
      EXPECT_EQ(of_machine.size(), 5U);  // k1, k2 and lambda under both conditions
      EXPECT_EQ(of_world.size(), 3U);
      EXPECT_EQ(machine_of_part.size(), 3U);
      EXPECT_EQ(world_of_part.size(), 2U);
      for (std::size_t i = 0; i < trial.inputs.size(); ++i) {
        const std::string name = study.columns.inputs[i].name;
        if (name == "initial.position") continue;
        const bool is_of_world = name.starts_with("plant.");
        const std::string in_file = overridden.contains(name) ? name + place : name;
        EXPECT_EQ((is_of_world ? of_world : of_machine).at(in_file), trial.inputs[i]) << in_file;
        EXPECT_EQ((is_of_world ? world_of_part : machine_of_part).at(name), trial.inputs[i]) << name;
      }
    }
  }
}

TEST(Conditions, OverriddenParametersAreInputColumnsOfTrials) {
  const Study study = study_of(
      manifest_with("conditions: {a: {}, b: {plant.inertia: 7.0e-4, friction.k2: 100}}\n"), {"machines=4"});
  const std::size_t inertia = column_of(study, "plant.inertia");
  for (std::int64_t i = 0; i < study.trials; ++i) {
    const StudyTrial trial = study_trial(study, 0, i);
    EXPECT_EQ(trial.inputs[inertia], i / 4 % 2 == 0 ? 5.54e-4 : 7.0e-4);
    EXPECT_EQ(trial.inputs[inertia], trial.parameters.plant.inertia);
  }
}

TEST(Conditions, MoreTrialsExtendEveryCondition) {
  for (const std::string design : {"monte_carlo", "sobol"}) {
    const std::string text = manifest_with("conditions: {a: {}, b: {friction.k2: {uniform: [1, 2]}}}\n");
    const Study few = study_of(text, {"machines=4", "design=" + design});
    const Study many = study_of(text, {"machines=4", "design=" + design, "trials=240"});
    for (std::int64_t i = 0; i < few.trials; ++i)
      EXPECT_EQ(study_trial(few, 0, i).inputs, study_trial(many, 0, i).inputs) << design;
  }
}

TEST(Conditions, NameValueAndOrderChangeTheHashOfTheStudy) {
  const auto hash = [](const std::string& conditions) {
    return study_of(manifest_with("conditions: " + conditions + "\n")).study_sha256;
  };
  const std::set<std::string> hashes{
      hash("{a: {}, b: {plant.inertia: 7.0e-4}}"), hash("{b: {plant.inertia: 7.0e-4}, a: {}}"),
      hash("{a: {}, c: {plant.inertia: 7.0e-4}}"), hash("{a: {}, b: {plant.inertia: 8.0e-4}}"),
      study_of(manifest_with("")).study_sha256};
  EXPECT_EQ(hashes.size(), 5U);
}

TEST(Conditions, MistakesAreReportedWithTheirPlaceAndRemedy) {
  const auto of = [](const std::string& conditions, const std::vector<std::string>& overrides = {}) {
    return refusal_of(manifest_with("conditions: " + conditions + "\n"), overrides);
  };
  const std::vector<std::pair<std::string, std::string>> faults{
      {of("{}"), "16:13: conditions: found no condition; expected 1 to"},
      {of("[a]"), "conditions: found a list"},
      {of("{a: {plant.inertai: 1}}"),
       "16:18: conditions.a.plant.inertai: unknown key, nearest known: plant.inertia"},
      {of("{a: {trials: 1}}"), "conditions.a.trials: a condition cannot override this key"},
      {of("{a: {plant.inertia: -1}}"), "16:33: conditions.a.plant.inertia: "},
      {of("{a: {plant.inertia: 1, plant.inertia: 2}}"), "duplicate key"},
      {of("{a: {command.targets: [1, 2], command.targets.0: 1}}"),
       "command.targets.0 is given twice in this condition"},
      {of("{a: {}, b: {controller.ki: 1.0e-5}}"),
       "16:40: conditions.b.controller.ki: controller.ki is swept at m.yaml:15:32: a condition cannot "
       "override "
       "it; expected one or the other"},
      {of("{a: {friction.lambda: {uniform: [1, 2], per: study}}}"),
       "friction.lambda is drawn per trial: an override is drawn as often as its parameter; expected per: "
       "trial"},
      {of("{a: {}, b: {}, c: {}}", {"machines=5", "trials=100"}),
       "100 trials cannot be divided equally among 5 machines under each of 3 conditions; expected a "
       "multiple of "
       "15, such as 90 or 105"},
      {of("{a: {}, b: {}}", {"trials=7"}),
       "7 trials cannot be divided equally among 2 conditions; expected a multiple of 2, such as 6 or 8"},
      {of("{a: {}, b: {}}", {"design=saltelli"}), "the trials of all conditions share factors"},
      {of("{a: {}, b: {}}", {"stop={success_rate_halfwidth: 0.1, max_trials: 48}"}),
       "sequential stopping does not distinguish conditions"},
      {of("{a: {plant.inertia: 7.0e-4}}",
          {"goal={within: 0.002, moves: 0.9}", "tune={free: {plant.inertia: [1.0e-4, 1.0e-3]}}"}),
       "plant.inertia is tuned at --set tune"}};
  for (const auto& [error, expected] : faults)
    EXPECT_TRUE(says(error, expected)) << error << "\n" << expected;
}

}  // namespace
}  // namespace zerocount::study

// `ages` and `aging` in a manifest: every machine bears each condition at each age on the same draws, its
// values follow the law of aging, and what is refused.
#include "core/friction/profile.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::study {
namespace {

/// A value that changes with age: its form in the manifest, and its law in numbers.
struct AgedValue {
  std::string name;
  std::string form;
  std::string law;
  std::string rate;
  double scale;
  std::optional<double> number;  ///< the number, if the value is not drawn from a distribution
};

const std::vector<AgedValue>& aged_pool() {
  static const std::vector<AgedValue> pool{
      {"friction.k1",
       "lognormal: {median: 110, cv: 0.2}",
       "exponential",
       "{normal: {mean: -0.3, sd: 0.1}}",
       1e6,
       {}},
      {"friction.k1",
       "profile: {mean: {uniform: [100, 120]}, cv: 0.2, correlation_length: 0.5}",
       "linear",
       "{uniform: [-0.2, 0.1]}",
       2e6,
       {}},
      {"friction.k2", "value: 750", "logarithmic", "0.1", 1e4, 750.0},
      {"friction.k2", "uniform: [600, 900], per: trial", "linear", "-0.05", 1e5, {}},
      {"friction.alpha", "uniform: [0.1, 0.9], per: study", "logarithmic", "{uniform: [0.1, 0.2]}", 1e5, {}},
      {"friction.breakaway",
       "triangular: [0.25, 0.3, 0.35]",
       "exponential",
       "{uniform: [0, 0.1], per: world}",
       1e6,
       {}},
      {"plant.inertia", "value: 5.54e-4", "linear", "{uniform: [0, 0.1]}", 1e6, 5.54e-4},
      {"dac.offset", "normal: {mean: 0, sd: 0.01}", "linear", "{normal: {mean: 0, sd: 0.5}}", 1e5, {}},
      {"initial.hardening", "uniform: [0, 1.0e-6]", "exponential", "-1", 1e6, {}}};
  return pool;
}

double law_at(const AgedValue& value, double rate, double age) {
  if (value.law == "linear") return 1.0 + rate * age / value.scale;
  if (value.law == "exponential") return std::exp(rate * age / value.scale);
  return 1.0 + rate * std::log10(1.0 + age / value.scale);
}

/// The sections of a manifest with these values, which change with age if `aging` is set.
std::string sections_with(const std::vector<AgedValue>& values, bool aging) {
  std::string text;
  for (const std::string section : {"plant", "friction", "dac", "initial"}) {
    std::string keys = section == "initial" ? "position: {uniform: [0, 6]}" : "";
    for (const AgedValue& one : values) {
      if (!one.name.starts_with(section + ".")) continue;
      const std::string form =
          aging ? fmt::format("{{{}, aging: {{{}: {}, scale: {}}}}}", one.form, one.law, one.rate, one.scale)
                : (one.number ? fmt::format("{}", *one.number) : "{" + one.form + "}");
      keys += fmt::format("{}{}: {}", keys.empty() ? "" : ", ", one.name.substr(section.size() + 1), form);
    }
    if (!keys.empty()) text += fmt::format("{}: {{{}}}\n", section, keys);
  }
  return text;
}

const std::string command_of_ages =
    "command: {targets: [{integers: [1, 9]}, 2], hold: 0.004}\nverdict: {dwell: 0.001, window: 0.001}\n"
    "encoder: {fine_errors: {noise: 0.1}}\n";

struct Shape {
  int machines{2}, conditions{0}, ages{1}, worlds{0}, each{1};
  std::string design{};

  int of_age() const { return std::max(conditions, 1); }
};

std::string manifest_of_shape(const Shape& shape, const std::vector<AgedValue>& values,
                              const std::optional<std::vector<double>>& ages) {
  std::string text =
      fmt::format("zerocount: 1\nname: aged\nseed: 11\ndesign: {}\nmachines: {}\ntrials: {}\n", shape.design,
                  shape.machines, shape.machines * shape.of_age() * shape.each * (ages ? shape.ages : 1));
  if (shape.worlds > 0) text += fmt::format("worlds: {}\n", shape.worlds);
  if (shape.conditions > 0) {
    text += "conditions: {";
    for (int c = 0; c < shape.conditions; ++c)
      text += fmt::format("{}c{}: {{controller.ki: {}}}", c == 0 ? "" : ", ", c, 1e-5 * (c + 1));
    text += "}\n";
  }
  if (ages) text += fmt::format("ages: {{at: [{}], unit: h}}\n", fmt::join(*ages, ", "));
  return text + sections_with(values, ages.has_value()) + command_of_ages;
}

class RandomShapes {
 public:
  int number(int low, int high) { return std::uniform_int_distribution<>(low, high)(generator_); }

  Shape shape() {
    const std::vector<std::string> designs{"monte_carlo", "latin_hypercube", "sobol"};
    Shape shape{.machines = 2 * number(1, 4), .conditions = number(0, 3), .ages = number(1, 4)};
    shape.worlds = number(0, 1) == 1 ? 2 : 0;
    shape.each = number(1, 3);
    shape.design = designs[static_cast<std::size_t>(number(0, 2))];
    return shape;
  }
  std::vector<double> ages(int count) {
    std::vector<double> ages{number(0, 1) == 0 ? 0.0 : 3.0};
    while (std::ssize(ages) < count) ages.push_back((ages.back() + 1.0) * number(2, 60));
    return ages;
  }
  std::vector<AgedValue> values(bool worlds) {
    std::vector<AgedValue> chosen;
    for (int i = 0; i < 4; ++i) {
      AgedValue one =
          aged_pool()[static_cast<std::size_t>(number(0, static_cast<int>(aged_pool().size()) - 1))];
      if (!worlds && one.rate.find("world") != std::string::npos) one.rate = "{uniform: [0, 0.1]}";
      const bool known = std::ranges::find(chosen, one.name, &AgedValue::name) != chosen.end();
      if (!known) chosen.push_back(one);
    }
    return chosen;
  }

 private:
  std::mt19937 generator_{20021};
};

double input_of(const Study& study, const StudyTrial& trial, const std::string& name) {
  return trial.inputs[column_of(study, name)];
}

bool has_column(const Study& study, const std::string& name) {
  return std::ranges::find(study.columns.inputs, name, &InputColumn::name) != study.columns.inputs.end();
}

double rate_of(const AgedValue& value, const Study& study, const StudyTrial& trial) {
  return has_column(study, value.name + ".aging") ? input_of(study, trial, value.name + ".aging")
                                                  : std::stod(value.rate);
}

// A table by a grouping counts every trial once, and as many in each of its groups.
TEST(Groupings, DivideTheTrialsEquallyAndIndependently) {
  constexpr std::int64_t trials = 240;
  for (const std::int64_t machines : {1, 4}) {
    const TrialIndices indices{.machines = machines, .settings = {.conditions = 3, .ages = 2}, .worlds = 2};
    const std::vector<std::int64_t> sizes{machines, 2, 3, 2};
    for (const GroupingTraits& of : groupings) {
      std::vector<std::int64_t> counted(
          static_cast<std::size_t>(sizes.at(static_cast<std::size_t>(of.grouping))));
      for (std::int64_t i = 0; i < trials; ++i)
        ++counted.at(static_cast<std::size_t>(indices.group_of(of.grouping, i)));
      EXPECT_EQ(counted, std::vector<std::int64_t>(counted.size(), trials / std::ssize(counted))) << of.name;
    }
    for (std::int64_t i = 0; i < trials; ++i) {
      // The conditions of an age are together. What a machine bears in turn leaves its draw as it is.
      EXPECT_EQ(indices.group_of(Grouping::condition, i) + 3 * indices.group_of(Grouping::age, i),
                indices.setting_of(i));
      for (const Grouping of_draw : {Grouping::machine, Grouping::world})
        EXPECT_EQ(indices.group_of(of_draw, indices.trial_of(indices.draw_of(i), 0)),
                  indices.group_of(of_draw, i));
    }
  }
}

// The definition: trial i is at age ⌊i/(R·C)⌋ mod A, with the draws of j = i mod R + R·⌊i/(R·C·A)⌋.
TEST(Ages, TrialsTakeThemInRotationWithTheDrawsOfAStudyWithoutAges) {
  RandomShapes random;
  for (int n = 0; n < 60; ++n) {
    const Shape shape = random.shape();
    const std::vector<double> ages = random.ages(shape.ages);
    const std::vector<AgedValue> values = random.values(shape.worlds > 0);
    const Study study = study_of(manifest_of_shape(shape, values, ages));
    const Study without = study_of(manifest_of_shape(shape, values, std::nullopt));
    ASSERT_EQ(study.settings.total(), shape.of_age() * shape.ages);
    std::vector<double> rates(static_cast<std::size_t>(shape.machines) * values.size(), 0.0);
    for (std::int64_t i = 0; i < study.trials; ++i) {
      const std::int64_t r = shape.machines;
      const std::int64_t c = i / r % shape.of_age();
      const std::int64_t a = i / (r * shape.of_age()) % shape.ages;
      const std::int64_t j = i % r + r * (i / (r * shape.of_age() * shape.ages));
      const double age = ages[static_cast<std::size_t>(a)];
      const std::int64_t same = i % r + r * (c + shape.of_age() * (j / r));
      const StudyTrial trial = study_trial(study, 0, i);
      const StudyTrial young = study_trial(without, 0, same);
      EXPECT_EQ(trial_indices(study).draw_of(i), j);
      EXPECT_EQ(trial.parameters.randomness.trial, young.parameters.randomness.trial);
      EXPECT_EQ(trial.parameters.command.targets, young.parameters.command.targets);
      EXPECT_EQ(trial.parameters.controller.ki, young.parameters.controller.ki);
      if (shape.worlds > 0) {
        EXPECT_EQ(group_of(study, Grouping::world, i), group_of(without, Grouping::world, same));
      }
      for (const InputColumn& column : without.columns.inputs) {
        const bool aged = std::ranges::any_of(
            values, [&](const AgedValue& one) { return column.name.starts_with(one.name); });
        if (!aged) {
          EXPECT_EQ(input_of(study, trial, column.name), input_of(without, young, column.name))
              << column.name;
        }
      }
      for (std::size_t v = 0; v < values.size(); ++v) {
        const AgedValue& value = values[v];
        const double rate = rate_of(value, study, trial);
        const double before = value.number ? *value.number : input_of(without, young, value.name);
        const double now = input_of(study, trial, value.name);
        EXPECT_NEAR(now, before * law_at(value, rate, age), 1e-12 * std::abs(before)) << value.name;
        if (age == 0.0) {
          EXPECT_EQ(now, before);
        }
        const std::string mean = value.name + ".profile.mean";
        if (has_column(study, mean)) {
          EXPECT_NEAR(input_of(study, trial, mean), input_of(without, young, mean) * law_at(value, rate, age),
                      1e-10);
        }
        double& of_machine = rates[static_cast<std::size_t>(i % r) * values.size() + v];
        if (i < r) of_machine = rate;
        EXPECT_EQ(of_machine, rate);  // drawn for each machine
      }
    }
  }
}

// The parameters of a trial have the values that its inputs say, whatever the engine.
TEST(Ages, ActInTheParametersOfTrials) {
  const Study study = study_of(
      manifest_of_shape({.machines = 2, .ages = 2, .each = 1, .design = "monte_carlo"},
                        {aged_pool()[1], aged_pool()[3], aged_pool()[6]}, std::vector<double>{0.0, 5e5}));
  for (std::int64_t i = 0; i < study.trials; ++i) {
    const StudyTrial trial = study_trial(study, 0, i);
    EXPECT_EQ(trial.parameters.plant.inertia, input_of(study, trial, "plant.inertia"));
    EXPECT_EQ(trial.parameters.friction.uniform.k2, input_of(study, trial, "friction.k2"));
    const double start = trial.parameters.initial.position;
    ASSERT_EQ(trial.parameters.friction.profiled.size(), 1U);
    const friction::Profile& old = *trial.parameters.friction.profiled[0].profile;
    const friction::Profile& young = *study_trial(study, 0, i % 2).parameters.friction.profiled[0].profile;
    const double factor = friction::value_at(old, start) / friction::value_at(young, start);
    for (const double angle : {0.0, 1.0, 2.5, 4.0})
      EXPECT_NEAR(friction::value_at(old, angle), factor * friction::value_at(young, angle), 1e-10);
    EXPECT_EQ(friction::value_at(old, start), input_of(study, trial, "friction.k1"));
  }
}

// Measured values age, and what follows from them follows at the age.
TEST(Ages, DerivedParametersUseTheMeasuredValuesAtTheAge) {
  const std::string aged =
      "friction: {measured: {initial_stiffness: 900, final_stiffness: {value: 100, aging: {linear: -0.2, "
      "scale: "
      "10}}, breakaway: 0.3, breakaway_travel: 1.0e-3}}\n";
  const Study study = study_of(
      "zerocount: 1\nname: m\nseed: 1\nmachines: 2\ntrials: 4\n"
      "ages: {at: [0, 10]}\n" +
      aged + command_of_ages);
  const Study at_80 = study_of(
      "zerocount: 1\nname: m\nseed: 1\nmachines: 2\ntrials: 2\nfriction: {measured: {initial_stiffness: 900, "
      "final_stiffness: 80, breakaway: 0.3, breakaway_travel: 1.0e-3}}\n" +
      command_of_ages);
  const StudyTrial old = study_trial(study, 0, 2);
  const StudyTrial same = study_trial(at_80, 0, 0);
  EXPECT_EQ(old.parameters.friction.uniform.k1, 80.0);
  EXPECT_EQ(old.parameters.friction.uniform.k1, same.parameters.friction.uniform.k1);
  EXPECT_EQ(old.parameters.friction.uniform.k2, same.parameters.friction.uniform.k2);
  EXPECT_EQ(old.parameters.friction.uniform.beta, same.parameters.friction.uniform.beta);
}

TEST(Ages, ScaleTheDrawsOfEachContact) {
  const std::string head = "zerocount: 1\nname: c\nseed: 1\nmachines: 2\n" + command_of_ages;
  const Study study =
      study_of(head +
               "trials: 4\nages: {at: [0, 10]}\nfriction: {k2: {uniform: [600, 900], per: contact, aging: "
               "{linear: 0.5, scale: 10}}}\n");
  const StudyTrial young = study_trial(study, 0, 0);
  const StudyTrial old = study_trial(study, 0, 2);
  ASSERT_EQ(old.parameters.friction.per_contact.size(), 1U);
  for (std::uint64_t contact = 0; contact < 5; ++contact)
    EXPECT_NEAR(old.parameters.friction.per_contact[0].value(contact),
                1.5 * young.parameters.friction.per_contact[0].value(contact), 1e-9);
}

// Overrides of conditions and values of a sweep without `aging` change with age as their parameter does.
TEST(Ages, AreInheritedByOverridesAndSweptValues) {
  const std::string text =
      "zerocount: 1\nname: o\nseed: 3\nmachines: 2\ntrials: 12\nages: {at: [0, 10]}\n"
      "friction: {k2: {value: 700, aging: {linear: -0.1, scale: 10}}}\n"
      "conditions: {a: {}, b: {friction.k2: 500}, c: {friction.k2: {value: 400, aging: {linear: 0.1, scale: "
      "10}}}}\n" +
      command_of_ages;
  const Study study = study_of(text);
  const std::vector<double> expected{700, 500, 400, 630, 450, 440};
  for (std::int64_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(input_of(study, study_trial(study, 0, i), "friction.k2"),
                expected[static_cast<std::size_t>(i / 2)], 1e-10);
  }
  const std::string swept =
      "zerocount: 1\nname: o\nseed: 3\nmachines: 2\ntrials: 4\nages: {at: [0, 10]}\n"
      "sweep: {cases: {steel: {friction.k2: {value: 700, aging: {linear: -0.1, scale: 10}}}, "
      "ceramic: {friction.k2: 600}}}\n" +
      command_of_ages;
  const Study cases = study_of(swept);
  EXPECT_NEAR(input_of(cases, study_trial(cases, 0, 2), "friction.k2"), 630, 1e-10);
  EXPECT_EQ(input_of(cases, study_trial(cases, 1, 2), "friction.k2"), 600);
  EXPECT_EQ(input_of(cases, study_trial(cases, 1, 2), "friction.k2.aging"), 0.0);
}

TEST(Ages, AreKeptByOverridesOfTheCommandLine) {
  const std::string text =
      "zerocount: 1\nname: o\nseed: 3\nmachines: 2\ntrials: 4\nages: {at: [0, 10]}\n"
      "friction: {k2: {value: 700, aging: {linear: -0.1, scale: 10}}}\n" +
      command_of_ages;
  const auto at_ten = [&](const std::string& override) {
    const Study study = study_of(text, {override});
    return input_of(study, study_trial(study, 0, 2), "friction.k2");
  };
  EXPECT_NEAR(at_ten("friction.k2=500"), 450, 1e-10);
  const double drawn = at_ten("friction.k2={uniform: [500, 510]}");
  EXPECT_GE(drawn, 450);
  EXPECT_LE(drawn, 459);
  EXPECT_NEAR(at_ten("friction.k2={value: 500, aging: {linear: 0.1, scale: 10}}"), 550, 1e-10);
  EXPECT_NEAR(at_ten("friction.k2.aging={linear: 0, scale: 1}"), 700, 1e-10);
}

TEST(Ages, TheStudyUnderOneSettingHasItsTrials) {
  RandomShapes random;
  for (int n = 0; n < 10; ++n) {
    const Shape shape = random.shape();
    const Study study =
        study_of(manifest_of_shape(shape, random.values(shape.worlds > 0), random.ages(shape.ages)));
    for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
      const Study alone = in_setting(study, setting);
      EXPECT_EQ(alone.trials, shape.machines * shape.each);
      for (std::int64_t j = 0; j < alone.trials; ++j) {
        const std::int64_t i = trial_indices(study).trial_of(j, setting);
        EXPECT_EQ(fmt::format("{}", fmt::join(study_trial(alone, 0, j).inputs, " ")),
                  fmt::format("{}", fmt::join(study_trial(study, 0, i).inputs, " ")));
      }
    }
    for (std::int64_t machine = 0; machine < study.machines; ++machine)
      EXPECT_NO_THROW(group_inputs(study, Grouping::machine, machine));
  }
}

TEST(Ages, AreNamedInFewDigits) {
  const Study study = study_of(
      "zerocount: 1\nname: named\nseed: 3\nmachines: 2\ntrials: 12\nages: {at: [0, 100000, 1234567], unit: "
      "km}\n"
      "conditions: {b: {friction.k2: {value: 400, aging: {linear: 0.1, scale: 1.0e+7}}}, a: {}}\n" +
      command_of_ages);
  EXPECT_EQ(labels_of(study.settings),
            (std::vector<std::string>{"b, 0 km", "a, 0 km", "b, 100000 km", "a, 100000 km", "b, 1234567 km",
                                      "a, 1234567 km"}));
  EXPECT_EQ(study.settings.conditions, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(setting_named(study, "a", 100000.0), 3);
  EXPECT_THROW(setting_named(study, "a", std::nullopt), std::exception);
  EXPECT_THROW(setting_named(study, "a", 5.0), std::exception);
}

std::string refusal_with(const std::string& more, const std::string& ages = "ages: {at: [0, 10]}\n") {
  return refusal_of("zerocount: 1\nname: f\nseed: 3\nmachines: 2\ntrials: 12\n" + ages + more +
                    command_of_ages);
}

TEST(Ages, MistakesAreReportedWithTheirPlaceAndRemedy) {
  const std::string k2 = "friction: {k2: {value: 700, aging: {linear: -0.05, scale: 10}}}\n";
  ASSERT_EQ(refusal_with(k2), "");
  const std::vector<std::pair<std::string, std::string>> faults{
      {refusal_with(k2, ""), "6:36: friction.k2.aging: the study has no ages; expected the key ages"},
      {refusal_of("zerocount: 1\nname: f\nseed: 3\ntrials: 12\nages: {at: [0, 10]}\n" + k2 + command_of_ages),
       "5:7: ages: only machines have ages: the study has none; expected the key machines"},
      {refusal_with(k2, "ages: {at: [0, 10, 10]}\n"), "ages.at.2: 10 is not above 10"},
      {refusal_with(k2, "ages: {at: []}\n"), "ages.at: the list is empty; expected a rising list"},
      {refusal_with(k2, "ages: {at: [-1, 10]}\n"), "ages.at.0: "},
      {refusal_with(k2, "ages: {unit: h}\n"), "ages.at: the key is missing"},
      {refusal_with(k2, "ages: {at: [0, 1], unit: \"operating hours\"}\n"),
       "ages.unit: 'operating hours' is not one word; expected a word such as cycles"},
      {refusal_with(k2, "ages: {at: [0, 1], every: 2}\n"), "ages.every: unknown key"},
      {refusal_with(k2, "ages: [0, 1]\n"), "ages: found a list"},
      {refusal_with(k2, "ages: {at: [0, 10]}\nsweep: {grid: {friction.k1.aging: [0, 1]}}\n"),
       "sweep.grid.friction.k1.aging: friction.k1 does not change with age in its section; expected "
       "friction.k1: {value: "},
      {refusal_with(k2, "ages: {at: [0, 1, 2, 3, 4]}\n"),
       "12 trials cannot be divided equally among 2 machines at each of 5 ages; expected a multiple of 10"},
      {refusal_with("friction: {k2: {value: 700, aging: {linear: -0.05}}}\n"),
       "k2.aging: the scale is missing"},
      {refusal_with("friction: {k2: {value: 700, aging: {scale: 2}}}\n"), "k2.aging: found 0 laws"},
      {refusal_with("friction: {k2: {value: 700, aging: null}}\n"), "{linear: 0, scale: 1} switches it off"},
      {refusal_with("friction: {k2: {value: 700, aging: {linear: 1, exponential: 1, scale: 2}}}\n"),
       "k2.aging: found 2 laws"},
      {refusal_with("friction: {k2: {value: 700, aging: {lineer: 1, scale: 2}}}\n"),
       "k2.aging.lineer: unknown key, nearest known: linear"},
      {refusal_with("friction: {k2: {value: 700, aging: {linear: 1, scale: 0}}}\n"), "k2.aging.scale: "},
      {refusal_with("friction: {k2: {value: 700}}\n"), "value is for a number that changes with age"},
      {refusal_with("friction: {k2: {value: 700, per: machine, aging: {linear: 1, scale: 2}}}\n"),
       "k2.per: a number is not drawn"},
      {refusal_with(
           "friction: {k2: {value: 700, aging: {linear: {uniform: [0, 1], per: trial}, scale: 2}}}\n"),
       "a rate of aging belongs to a machine; expected per: machine, world or study"},
      {refusal_with(
           "friction: {k2: {value: 700, aging: {linear: {value: 1, aging: {linear: 1, scale: 2}}, scale: "
           "2}}}\n"),
       "the rate itself does not change with age"},
      {refusal_with("encoder: {fine: {integers: [100, 200], aging: {linear: 1, scale: 2}}}\n"),
       "whole numbers do not change with age"},
      {refusal_with("friction: {k2: {value: 700, aging: {linear: -1.5, scale: 10}}}\n"),
       "friction.k2: its values at 10 cycles, -350 to -350, leave the allowed range"},
      {refusal_with(
           "friction: {k2: {uniform: [600, 900], aging: {linear: {normal: {mean: 0, sd: 1}}, scale: 10}}}\n"),
       "friction.k2: its values at 10 cycles, -"},
      {refusal_with(
           "friction: {k1: {profile: {mean: 100, cv: 0.1, correlation_length: 1}, aging: {linear: -1.1, "
           "scale: 10}}}\n"),
       "friction.k1: its values at 10 cycles, -"},
      {refusal_with("friction: {coulomb_ratio: {value: 0.8, aging: {logarithmic: 0.5, scale: 1}}}\n"),
       "friction.coulomb_ratio: its values at 10 cycles, 1.2"},
      {refusal_with(k2 + "design: saltelli\n"), "the trials of all ages share factors"},
      {refusal_with(k2 + "stop: {success_rate_halfwidth: 0.1, max_trials: 48}\n"),
       "sequential stopping does not distinguish ages"},
      {refusal_with(k2 + "goal: {within: 0.002, moves: 0.9}\ntune: {free: {friction.k2: [500, 700]}}\n"),
       "friction.k2 changes with age"},
      {refusal_with(k2 + "goal: {within: 0.002, moves: 0.9}\ntune: {free: {friction.k2.aging: [-0.1, 0]}}\n"),
       "a rate of aging belongs to the machine, and is not tuned"},
      {refusal_with(k2 + "sweep: {grid: {friction.k2.aging: [-0.1, -0.2], friction.k2: [{value: 700, aging: "
                         "{linear: 0, scale: 1}}, 600]}}\n"),
       "friction.k2.aging is swept twice"},
      {refusal_with(k2 + "conditions: {a: {friction.k2: {value: 700, aging: {linear: 0, scale: 1}}}}\n"
                         "sweep: {grid: {friction.k2.aging: [-0.1, -0.2]}}\n"),
       "friction.k2.aging is swept at m.yaml:9:36: a condition cannot override it"},
      {refusal_with(k2 + "conditions: {a: {friction.k2.aging: -0.1, friction.k2: {value: 700, aging: "
                         "{linear: 0, scale: 1}}}}\n"),
       "friction.k2.aging is given twice in this condition"}};
  for (const auto& [error, expected] : faults)
    EXPECT_TRUE(says(error, expected)) << error << "\n" << expected;
}

// A normal rate that can be drawn leaves no value out of range is allowed, as what is drawn has ends.
TEST(Ages, RangeChecksUseTheEndsOfTheDistributions) {
  EXPECT_EQ(
      refusal_with("friction: {k2: {lognormal: {median: 700, cv: 0.2}, aging: {linear: {normal: {mean: -0.1, "
                   "sd: 0.05}}, scale: 10}}}\n"),
      "");
}

TEST(Ages, AgesThatChangeNothingGiveAWarning) {
  const Study study = study_of(
      "zerocount: 1\nname: f\nseed: 3\nmachines: 2\ntrials: 12\nages: {at: [0, 10]}\n" + command_of_ages);
  ASSERT_FALSE(study.warnings.empty());
  EXPECT_TRUE(says(study.warnings.back(), "ages: the ages are all alike"));
}

// The manifest of a point and condition keeps the law of the section for a value that replaces the section's.
TEST(Ages, StandInTheManifestOfAPoint) {
  const Study study = study_of(
      "zerocount: 1\nname: p\nseed: 3\nmachines: 2\ntrials: 4\nages: {at: [0, 10]}\n"
      "friction: {k2: {value: 700, aging: {linear: -0.1, scale: 10}}}\n"
      "sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5], friction.k2: [500, 600], friction.k2.aging: [-0.1, "
      "-0.2]}}\n" +
      command_of_ages);
  for (std::int64_t p = 0; p < 8; ++p) {
    const Study point = study_of(manifest_text::manifest_of_point(study, p, {}));
    for (std::int64_t i = 0; i < 4; ++i)
      EXPECT_EQ(study_trial(point, 0, i).parameters.friction.uniform.k2,
                study_trial(study, p, i).parameters.friction.uniform.k2);
  }
  EXPECT_NEAR(study_trial(study, 7, 2).parameters.friction.uniform.k2, 600 * 0.8, 1e-10);
}

}  // namespace
}  // namespace zerocount::study

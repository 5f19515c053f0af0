// A study with other values is the same, to the bit, as the one whose manifest has these values.
#include "runners/trials/variant.hpp"

#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/trials/effort.hpp"
#include "tests/support/test.hpp"

namespace zerocount::trials {
namespace {

const char* const manifests[] = {
    ("zerocount: 1\nname: rotary\nseed: 4\ntrials: 8\ncommand: {targets: [12], hold: 0.2}\n"
     "friction: {k1: {lognormal: {median: 110, cv: 0.2}}}\ncontroller: {ki: 3.85e-5, delay: 1}\n"
     "goal: {band: 1, within: 0.15, moves: 0.9}\n"),
    ("zerocount: 1\nname: si\nseed: 5\ntrials: 8\nmachines: 4\ncommand: {targets: [500], hold: 0.2}\n"
     "plant: {presliding_damping: 0.2, sliding_damping: 1.0e-3}\n"
     "friction: {model: lugre, alpha: {uniform: [0.5, 2]}}\n"
     "controller: {units: si, sample_rate: 4000, kp: 3.0, ki: 40, kd: 0.02}\n"
     "encoder: {fine_errors: {noise: 0.1}}\n"),
    ("zerocount: 1\nname: two phases\nseed: 6\ntrials: 8\ncommand: {targets: [200], hold: 0.2}\n"
     "controller: {ki: 2.0e-5, coarse: {coarse_beyond: 40, fine_within: 10, kp: 1.0e-4, ki: 2.0e-5}}\n"),
    // Gains and friction beyond the ranges of a rotary axis.
    ("zerocount: 1\nname: linear\nseed: 7\ntrials: 8\naxis: linear\ncommand: {targets: [400], hold: 0.1}\n"
     "plant: {inertia: 3.2, presliding_damping: 400, sliding_damping: 20}\nencoder: {resolution: 5.0e-9}\n"
     "friction: {k1: 2.0e+4, k2: 3.0e+6, beta: 4.6e+5, breakaway: 4, lambda: 1.0e+8, stribeck_velocity: "
     "1.0e-3}\n"
     "controller: {units: si, sample_rate: 8000, kp: 2.0e+6, ki: 1.4e+9, kd: 4346}\n"
     "dac: {bits: 16, range: 60}\ngoal: {band: 2, within: 0.05, moves: 0.9}\n"),
    ("zerocount: 1\nname: conditions\nseed: 8\ntrials: 8\ncommand: {targets: [12], hold: 0.2}\n"
     "conditions: {empty: {}, loaded: {plant.inertia: 9.0e-4, controller.delay: {uniform: [1, 2]}}}\n"
     "friction: {k1: {lognormal: {median: 110, cv: 0.2}}}\ncontroller: {ki: 3.85e-5, delay: 1}\n"
     "goal: {band: 1, within: 0.15, moves: 0.9}\n"),
};

/// The study whose manifest has these values for the named parameters; empty if they are refused, with the
/// message in `refusal`.
std::optional<study::Study> parsed(const study::Study& study, const std::vector<std::string>& names,
                                   const std::vector<double>& values, std::string& refusal) {
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < names.size(); ++i)
    overrides.push_back(fmt::format("{}={}", names[i], values[i]));
  try {
    return variant_of(study, overrides);
  } catch (const Failure& failure) {
    refusal = failure.what();
    return std::nullopt;
  }
}

double value_of(const study::Study& study, const std::string& name) {
  const std::vector<std::string_view> names{name};
  return study.plan->base[study::slots_named(study.plan->table, names).front()].number;
}

bool is_overridden(const study::StudyPlan& plan, std::size_t slot) {
  return plan.settings_axis &&
         std::ranges::find(plan.axes[*plan.settings_axis].assignments, slot, &study::Assignment::slot) !=
             plan.axes[*plan.settings_axis].assignments.end();
}

/// The paths of the parameters of the study that are a single number and have an effect.
std::vector<std::string> one_numbers(const study::Study& study) {
  std::vector<std::string> names;
  const study::StudyPlan& plan = *study.plan;
  std::string refusal;
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    const parameters::Parameter& row = plan.table.rows[slot];
    const bool number =
        row.kind == parameters::ParameterKind::real || row.kind == parameters::ParameterKind::whole_number;
    const std::string name(row.name);
    if (number && plan.base[slot].kind == study::Value::Kind::number && !is_overridden(plan, slot) &&
        parsed(study, {name}, {plan.base[slot].number}, refusal))
      names.push_back(name);
  }
  return names;
}

double other_value(const study::Study& study, const std::string& name, std::mt19937& random) {
  const double value = value_of(study, name);
  std::normal_distribution<double> normal;
  const std::vector<std::string_view> names{name};
  const auto kind = study.plan->table.rows[study::slots_named(study.plan->table, names).front()].kind;
  if (value == 0.0 || std::isnan(value)) {
    const double from_zero = std::exp(-6.0 + 4.0 * normal(random));
    return kind == parameters::ParameterKind::whole_number ? std::ceil(from_zero) : from_zero;
  }
  const double scaled = value * std::exp(0.5 * normal(random));
  return value == std::round(value) ? std::round(scaled) : scaled;
}

std::vector<double> motion_of(const study::Study& study, std::int64_t trial) {
  std::vector<double> motion;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) {
    motion.insert(motion.end(), {sample.theta, sample.torque, static_cast<double>(sample.count)});
  };
  trial::run_trial(study::study_trial(study, 0, trial).parameters, observers);
  return motion;
}

TEST(Variant, WithValuesEqualsTheStudyWithTheseValuesInItsManifest) {
  std::mt19937 random(3);
  int allowed = 0, refused = 0;
  for (const char* const text : manifests) {
    const study::Study study = manifest::parse_study(text, "test");
    const std::vector<std::string> all = one_numbers(study);
    for (int i = 0; i < 60; ++i) {
      std::vector<std::string> names;
      std::vector<double> values;
      for (std::size_t k = 0; k < 1 + random() % 3; ++k) {
        names.push_back(all[random() % all.size()]);
        values.push_back(other_value(study, names.back(), random));
      }
      const std::optional<study::Study> edited = with_values(study, names, values);
      std::string refusal;
      const std::optional<study::Study> expected = parsed(study, names, values, refusal);
      SCOPED_TRACE(fmt::format("{}: {} = {}: {}", study.name, fmt::join(names, ", "), fmt::join(values, ", "),
                               refusal));
      // Such a manifest is a mistake, or does not say what it has to.
      if (refusal.find("it has no effect") != std::string::npos ||
          refusal.find("the key is missing") != std::string::npos)
        continue;
      ASSERT_EQ(edited.has_value(), expected.has_value());
      (edited ? allowed : refused) += 1;
      if (edited && expected) {
        EXPECT_EQ(motion_of(*edited, i % 8), motion_of(*expected, i % 8));
      }
    }
  }
  EXPECT_GT(allowed, 60);
  EXPECT_GT(refused, 5);
}

// Each trial under a condition is one of the study under that condition alone, whatever was changed before.
TEST(Variant, UnderAConditionHasTheTrialsOfThatCondition) {
  const study::Study study = manifest::parse_study(manifests[std::size(manifests) - 1], "test");
  const std::vector<std::string> names{"controller.ki"};
  const study::Study edited = with_values(study, names, std::vector<double>{2.0e-5}).value();
  for (const study::Study* one : {&study, &edited}) {
    const study::TrialIndices indices = study::trial_indices(*one);
    for (std::int64_t trial = 0; trial < one->trials; ++trial) {
      const study::Study alone = in_setting(*one, indices.setting_of(trial));
      EXPECT_EQ(alone.trials, study::draw_count(*one));
      EXPECT_EQ(motion_of(*one, trial), motion_of(alone, indices.draw_of(trial))) << trial;
    }
  }
}

TEST(Variant, AFreshSeedDiffersForEachPurpose) {
  EXPECT_NE(fresh_seed(1, "confirmation"), fresh_seed(1, "tuning, proof 1"));
  EXPECT_EQ(fresh_seed(1, "confirmation"), fresh_seed(1, "confirmation"));
  for (std::uint64_t seed = 0; seed < 100; ++seed) EXPECT_LT(fresh_seed(seed, "x"), std::uint64_t{1} << 52U);
}

// What a task may spend: trials and time, counted in one place.

using std::chrono::milliseconds;

TEST(Effort, WithoutLimitsIsNeverExhausted) {
  const Effort effort;
  effort.spend(std::int64_t{1} << 40);
  EXPECT_FALSE(effort.is_spent());
  EXPECT_EQ(effort.seconds_left(), std::numeric_limits<double>::infinity());
}

// However the whole is divided, its trials are not exceeded, and what a part leaves stays with the whole.
TEST(Effort, NeverSpendsMoreTrialsThanItHas) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int64_t> number(1, 400);
  for (int round = 0; round < 200; ++round) {
    const std::int64_t limit = number(random);
    const Effort whole = Effort().limited_to(limit, {});
    std::vector<Effort> efforts{whole};
    std::int64_t counted = 0;
    for (int i = 0; i < 30; ++i) {
      const Effort one = efforts[static_cast<std::size_t>(number(random)) % efforts.size()];
      if (i % 3 == 0) efforts.push_back(one.limited_to(number(random), {}));
      const std::int64_t trials = number(random) / 8;
      const std::int64_t remaining = one.trials_left();
      const bool enough = within(one, [&] { one.spend(trials); });
      EXPECT_EQ(enough, trials <= remaining);
      counted += enough ? trials : 0;
    }
    EXPECT_LE(counted, limit);
    EXPECT_EQ(whole.spent_trials(), counted);
    EXPECT_EQ(whole.trials_left(), limit - counted);
  }
}

// Equal parts, taken one after the other, are all that there is; what one of them leaves goes to the later
// ones.
TEST(Effort, IsDividedIntoEqualParts) {
  const Effort whole = Effort().limited_to(1000, 60.0);
  for (std::int64_t left = 4; left > 0; --left) {
    const Effort part = whole.part(left);
    EXPECT_EQ(part.trials_left(), whole.trials_left() / left);
    EXPECT_NEAR(part.seconds_left(), 60.0 / static_cast<double>(left), 1.0);
    part.spend(left == 3 ? 10 : part.trials_left());
  }
  EXPECT_EQ(whole.trials_left(), 0);
  EXPECT_EQ(Effort().part(3).trials_left(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(Effort().part(3).seconds_left(), std::numeric_limits<double>::infinity());
}

TEST(Effort, StopsRunningWorkWhenItsTimeIsOver) {
  const Effort whole = Effort().limited_to({}, 60.0);
  const auto start = std::chrono::steady_clock::now();
  const Effort part = whole.limited_to({}, 0.05);
  const bool ended = within(part, [&] {
    while (!part.stop().stop_requested()) std::this_thread::sleep_for(milliseconds(1));
    throw trial::Interrupted{};
  });
  EXPECT_FALSE(ended);
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(50));
  EXPECT_TRUE(part.is_spent());
  EXPECT_FALSE(part.is_interrupted());
  EXPECT_FALSE(whole.is_spent());
}

TEST(Effort, DistinguishesAStopRequestFromATimeout) {
  std::stop_source user;
  const Effort part = Effort(user.get_token()).limited_to(1000, 60.0).limited_to({}, 30.0);
  user.request_stop();
  EXPECT_TRUE(part.stop().stop_requested());
  EXPECT_TRUE(part.is_interrupted());
  EXPECT_THROW(within(part, [] { throw trial::Interrupted{}; }), trial::Interrupted);
}

// A study under one condition, or at one age, has the machines and draws of the whole one.

constexpr const char* whole_life = R"(zerocount: 1
name: life
seed: 3
trials: 96
machines: 4
design: {}
ages: {{at: [0, 1.0e+5, 1.0e+6], unit: cycles}}
conditions: {{warm: {{}}, "very. cold": {{plant.inertia: 8.0e-4, friction.k1: {{uniform: [120, 150]}}}}}}
command: {{targets: [{{integers: [1, 30]}}], hold: 0.2}}
friction:
  k1: {{lognormal: {{median: 110, cv: 0.2}}, aging: {{exponential: {{normal: {{mean: -0.3, sd: 0.1}}}}, scale: 1.0e+6}}}}
  lambda: {{value: 10, aging: {{logarithmic: -0.05, scale: 1.0e+4}}}}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
)";

void expect_same(const study::Study& one, const study::Study& whole) {
  const study::TrialIndices indices = study::trial_indices(one);
  const study::TrialIndices all = study::trial_indices(whole);
  EXPECT_EQ(study::draw_count(one), study::draw_count(whole));
  for (std::int64_t trial = 0; trial < one.trials; ++trial) {
    const std::string name = study::label_of(one.settings, indices.setting_of(trial));
    const std::vector<std::string> labels = study::labels_of(whole.settings);
    const auto setting = std::ranges::find(labels, name) - labels.begin();
    ASSERT_LT(setting, std::ssize(labels)) << name;
    EXPECT_EQ(study::study_trial(one, 0, trial).inputs,
              study::study_trial(whole, 0, all.trial_of(indices.draw_of(trial), setting)).inputs)
        << name << ", trial " << trial;
  }
}

TEST(RestrictedStudy, HasTheMachinesAndDrawsOfTheWholeStudy) {
  for (const char* design : {"monte_carlo", "latin_hypercube", "sobol"}) {
    const study::Study whole =
        manifest::parse_study(fmt::format(fmt::runtime(whole_life), design), "life.yaml");
    for (const auto& condition : {std::optional<std::string>(), std::optional<std::string>("very. cold")}) {
      for (const auto& age : {std::optional<double>(), std::optional(1.0e5)}) {
        const study::Study one = restricted_to(whole, condition, age);
        EXPECT_EQ(one.settings.conditions.size(), condition ? 1U : 2U);
        EXPECT_EQ(one.settings.ages.at.size(), age ? 1U : 3U);
        expect_same(one, whole);
      }
    }
  }
}

TEST(RestrictedStudy, RefusesUnknownConditionsAndAges) {
  const study::Study whole =
      manifest::parse_study(fmt::format(fmt::runtime(whole_life), "monte_carlo"), "life.yaml");
  EXPECT_THROW(restricted_to(whole, "hot", {}), Failure);
  EXPECT_THROW(restricted_to(whole, {}, 7.0), Failure);
}

}  // namespace
}  // namespace zerocount::trials

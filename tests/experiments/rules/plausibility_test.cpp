// Warnings of values that are allowed but absurd give the number and its place. Other values cause none.
#include "experiments/rules/value_sources.hpp"
#include "experiments/study/study.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::rules {
namespace {

std::vector<std::string> warnings_of(const std::string& more) {
  return study_of(minimal_manifest(more)).warnings;
}

/// Tests with random axes whose parameters lie around those of the paper.
class Plausibility : public testing::Test {
 protected:
  double log_uniform(double low, double high) {
    return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random_));
  }
  static constexpr int rounds = 200;

 private:
  std::mt19937_64 random_{5};
};

/// The travel (rad) at which the virgin curve of the friction spring with the default k2 reaches `torque` (N
/// m), by bisection.
double travel_to(double torque, double k1, double beta) {
  double low = 0.0;
  double high = torque / k1;
  for (int i = 0; i < 200; ++i) {
    const double x = 0.5 * (low + high);
    const bool is_below = k1 * x + 750.0 / (2.0 * beta) * (1.0 - std::exp(-2.0 * beta * x)) < torque;
    (is_below ? low : high) = x;
  }
  return low;
}

TEST_F(Plausibility, WarnsOfANaturalFrequencyBelowTwoHertzOrAboveNyquist) {
  int low = 0;
  int high = 0;
  for (int i = 0; i < rounds; ++i) {
    const double inertia = log_uniform(1e-6, 100);
    const double k1 = log_uniform(50, 500);
    const double k2 = log_uniform(200, 2000);
    const double frequency = std::sqrt((k1 + k2) / inertia) / (2.0 * std::numbers::pi);
    const std::vector<std::string> warnings = warnings_of(fmt::format(
        "plant: {{inertia: «{:.17g}»}}\nfriction: {{k1: {:.17g}, k2: {:.17g}}}\n", inertia, k1, k2));
    if (frequency >= 2.0 && frequency <= 1000.0) {
      EXPECT_TRUE(warnings.empty()) << frequency << warnings.front();
      continue;
    }
    ++(frequency < 2.0 ? low : high);
    EXPECT_TRUE(has_faults(warnings, fmt::format("«»: plant.inertia | {:.3g} Hz | expected {}", frequency,
                                                 frequency < 2.0 ? "at least 2 Hz" : "less than half")));
  }
  EXPECT_GT(low, rounds / 20);
  EXPECT_GT(high, rounds / 20);
}

TEST_F(Plausibility, WarnsIfTheSpringDoesNotSoftenBeforeItSlides) {
  for (int i = 0; i < rounds; ++i) {
    const double beta = log_uniform(1e-2, 1e6);
    const double breakaway = log_uniform(0.05, 3);
    const double k1 = log_uniform(50, 500);
    const double softening = beta * travel_to(breakaway, k1, beta);
    const std::string friction =
        fmt::format("beta: «{:.17g}», breakaway: {:.17g}, k1: {:.17g}", beta, breakaway, k1);
    const std::vector<std::string> warnings = warnings_of("friction: {" + friction + "}\n");
    if (softening >= 0.1) {
      EXPECT_TRUE(warnings.empty()) << softening;
    } else {
      EXPECT_TRUE(has_faults(warnings, fmt::format("«»: friction.beta | {:.3g} | /µrad", softening)));
    }
    // Without k2 there is nothing that softens (and beta has no effect, which is a warning of its own).
    EXPECT_TRUE(
        has_faults(warnings_of("friction: {k2: 0, " + friction + "}\n"), "«»: friction.beta | no effect"));
  }
}

// Of breakaway 0.3 N m after 2 mrad, 150 N m/rad.
TEST_F(Plausibility, WarnsIfAMeasuredSpringIsALineOrAStep) {
  const auto warnings = [](double initial, double inertia) {
    return warnings_of(fmt::format(
        "friction: {{measured: {{initial_stiffness: «{:.17g}», final_stiffness: 100, breakaway: 0.3, "
        "breakaway_travel: 2.0e-3}}}}\nplant: {{inertia: {}}}\n",
        initial, inertia));
  };
  for (int i = 0; i < rounds; ++i) {
    const double ratio = 1.0 - log_uniform(1e-4, 0.5);  // (1 - exp(-y))/y, y = 2 beta travel
    const std::vector<std::string> line = warnings(100.0 + 50.0 / ratio, 5.54e-4);
    if (ratio <= -std::expm1(-0.2) / 0.2) {
      EXPECT_TRUE(line.empty()) << ratio;
    } else {
      EXPECT_TRUE(has_faults(line, "«»: friction.measured.initial_stiffness | before it softens | stiffer"));
    }
    const double initial = log_uniform(1e5, 1e7);
    const std::vector<std::string> step = warnings(initial, 10.0);
    if (initial <= 1e4 * 150.0) {
      EXPECT_TRUE(step.empty()) << initial;
    } else {
      EXPECT_TRUE(has_faults(step, fmt::format("«»: friction.measured.initial_stiffness | {:.4g} N m/rad | "
                                               "{:.3g} times",
                                               initial, initial / 150.0)));
    }
  }
}

TEST_F(Plausibility, WarnsOfADelayThatIsNotInSamples) {
  for (int i = 0; i < rounds; ++i) {
    const double delay = log_uniform(1e-6, 100);
    const std::vector<std::string> warnings =
        warnings_of(fmt::format("controller: {{delay: «{:.17g}»}}\n", delay));
    if (delay >= 0.01 && delay <= 20.0) {
      EXPECT_TRUE(warnings.empty()) << delay;
    } else if (delay > 20.0) {
      EXPECT_TRUE(has_faults(
          warnings, fmt::format("«»: controller.delay | {:.6g} µs are {:.6g} samples", delay, 2e-3 * delay)));
    } else {
      EXPECT_TRUE(has_faults(warnings, fmt::format("«»: controller.delay | {:.6g} s are {:.6g} samples",
                                                   delay, 2000.0 * delay)));
    }
  }
  EXPECT_TRUE(warnings_of("controller: {delay: 0}\n").empty());
}

TEST_F(Plausibility, WarnsIfTheSpringYieldsByAFewCountsOnly) {
  for (int i = 0; i < rounds; ++i) {
    const double breakaway = log_uniform(1e-3, 10);
    const double k1 = log_uniform(50, 500);
    const int fine = static_cast<int>(log_uniform(1000, 5e6));
    const double counts = travel_to(breakaway, k1, 1e7) / (2.0 * std::numbers::pi / fine);
    const std::vector<std::string> warnings = warnings_of(
        fmt::format("friction: {{breakaway: «{:.17g}», k1: {:.17g}, beta: 1.0e+7}}\nencoder: {{fine: {}}}\n",
                    breakaway, k1, fine));
    if (counts >= 5.0) {
      EXPECT_TRUE(warnings.empty()) << counts;
    } else {
      EXPECT_TRUE(
          has_faults(warnings, fmt::format("«»: friction.breakaway | {:.3g} counts | at least 5", counts)));
    }
  }
}

TEST_F(Plausibility, WarnsIfOneCountExceedsTheRangeOfTheConverter) {
  for (int i = 0; i < rounds; ++i) {
    const double gain = log_uniform(1e-3, 1e3);
    const double range = log_uniform(1e-2, 1e2);
    const std::string dac = fmt::format("dac: {{range: {:.17g}}}\n", range);
    for (const char* const key : {"kp", "ki", "kd"}) {
      const std::vector<std::string> warnings =
          warnings_of(fmt::format("controller: {{{}: «{:.17g}»}}\n{}", key, gain, dac));
      if (gain <= range) {
        EXPECT_TRUE(warnings.empty());
      } else {
        EXPECT_TRUE(has_faults(
            warnings, fmt::format("«»: controller.{} | {:.3g} N m | say controller.units: si", key, gain)));
      }
    }
  }
}

// kp·Δx, ki·Δx·T/2 and kd·Δx/T.
TEST_F(Plausibility, WarnsIfOneCountExceedsTheRangeWithGainsInSiUnits) {
  const double count = 2.0 * std::numbers::pi / 1620000.0;
  const double T = 1.0 / 2000.0;
  const double range = 0.5;
  const std::string rest = "dac: {range: 0.5}\n";
  const auto with = [&](const char* key, double gain) {
    const std::string ki = std::string(key) == "ki" ? "" : "ki: 1, ";
    return warnings_of(fmt::format("controller: {{units: si, {}{}: {:.17g}}}\n{}", ki, key, gain, rest));
  };
  for (const auto& [key, per_count] : {std::pair("kp", count), {"ki", count * T / 2.0}, {"kd", count / T}}) {
    EXPECT_TRUE(with(key, 0.99 * range / per_count).empty()) << key;
    const std::vector<std::string> warnings = with(key, 1.01 * range / per_count);
    ASSERT_EQ(warnings.size(), 1u) << key;
    EXPECT_TRUE(says(warnings[0], "controller.units: count"));
  }
}

// Tails are not typical, and neither is one point of many, unless it is absurd itself.
TEST_F(Plausibility, ChecksTheMedianAtEveryPoint) {
  EXPECT_TRUE(warnings_of("plant: {inertia: {lognormal: {median: 5.0e-4, cv: 2}}}\n").empty());
  EXPECT_TRUE(has_faults(warnings_of("plant: {inertia: «{lognormal: {median: 8, cv: 0.1}}»}\n"),
                         "«»: plant.inertia | 1.65 Hz"));
  EXPECT_TRUE(has_faults(
      warnings_of("friction: {k1: «{profile: {mean: 1.0e+7, cv: 0.1, correlation_length: 0.2}}»}\n"),
      "«»: friction.k1 | Hz\n«»: friction.k1 | pre-sliding range\n«»: friction.k1 | 0.00773 counts"));
  // Told once, at the first point that is absurd.
  EXPECT_TRUE(has_faults(warnings_of("sweep: {grid: {plant.inertia: [5.0e-4, «8», 9]}}\n"),
                         "«»: plant.inertia | 8 kg m^2"));
}

TEST_F(Plausibility, ChecksOnlyTheParametersOfTheLaw) {
  EXPECT_TRUE(warnings_of("plant: {inertia: 8}\nfriction: {model: coulomb}\n").empty());
  EXPECT_TRUE(has_faults(warnings_of("plant: {inertia: «8»}\nfriction: {model: lugre}\n"),
                         "«»: plant.inertia | sigma0"));
  EXPECT_TRUE(warnings_of("controller: {structure: cascade, cascade: {kv: 10, kp: 1, ki: 1}}\n").empty());
  EXPECT_TRUE(has_faults(warnings_of("controller: {coarse: {coarse_beyond: 1000, kp: «3»}}\n"),
                         "«»: controller.coarse.kp | 3 N m"));
}

// What a study says of each effect that a real axis has: it acts, it is stated to be absent, or it is assumed
// away.

using study::PremiseState;

/// For each assumption about an absent effect, its state; assumptions that the manifest does not mention are
/// left out.
std::map<std::string_view, PremiseState> stated_by(const std::string& more,
                                                   const std::vector<std::string>& overrides = {}) {
  std::map<std::string_view, PremiseState> stated;
  for (const study::Premise& premise : study_of(minimal_manifest(more), overrides).premises) {
    if (premise.state != PremiseState::assumed) stated[premise.assumption] = premise.state;
  }
  return stated;
}

struct Effect {
  const char* assumption;
  const char* key;
  double value;
};

constexpr std::array<Effect, 8> effects{
    {{"no encoder noise", "encoder.fine_errors.noise", 0.2},
     {"no other encoder errors", "encoder.fine_errors.eccentricity", 1e-4},
     {"no delay", "controller.delay", 1},
     {"no jitter", "controller.jitter", 1e-5},
     {"ideal amplifier", "amplifier.bandwidth", 500},
     {"ideal converter", "dac.gain_error", 0.01},
     {"rigid", "plant.load.inertia", 1e-4},
     {"no disturbance", "disturbance.torque", 0.01}}};

// Any mixture of keys that are left out, 0, a number, drawn, swept or of a condition.
TEST(Premises, AKeyStatesItsEffectHoweverItIsGiven) {
  std::mt19937_64 random(9);
  std::map<int, int> seen;
  for (int i = 0; i < 60; ++i) {
    std::map<std::string_view, PremiseState> expected;
    std::string grid;
    std::string loaded;
    std::string flat;
    std::vector<std::string> overrides;
    for (const Effect& effect : effects) {
      const int how = std::uniform_int_distribution(0, 5)(random);
      ++seen[how];
      if (how == 0) continue;
      expected[effect.assumption] = how == 1 ? PremiseState::stated_none : PremiseState::considered;
      if (how == 1) overrides.push_back(fmt::format("{}=0", effect.key));
      if (how == 2) overrides.push_back(fmt::format("{}={}", effect.key, effect.value));
      if (how == 3) overrides.push_back(fmt::format("{}={{uniform: [0, {}]}}", effect.key, effect.value));
      if (how == 4) grid += fmt::format("{}{}: [0, {}]", grid.empty() ? "" : ", ", effect.key, effect.value);
      if (how == 5) loaded += fmt::format("{}{}: {}", loaded.empty() ? "" : ", ", effect.key, effect.value);
    }
    std::string more;
    if (!grid.empty()) more += "sweep: {grid: {" + grid + "}}\n";
    if (!loaded.empty()) more += "conditions: {plain: {controller.ki: 2.0e-5}, other: {" + loaded + "}}\n";
    EXPECT_EQ(stated_by(more, overrides), expected) << more << fmt::format("{}", fmt::join(overrides, "\n"));
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(Premises, ListsAndSpectraAreEffectsToo) {
  using Stated = std::map<std::string_view, PremiseState>;
  const Stated acts{{"no disturbance", PremiseState::considered}};
  EXPECT_EQ(stated_by("disturbance: {ripple: [{amplitude: 0.01, periods: 100}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{amplitude: 0.01, frequency: 100}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{spectrum: [[1, 1.0e-8], [100, 1.0e-8]]}]}\n"), acts);
  EXPECT_EQ(stated_by("disturbance: {vibration: [{amplitude: 0, frequency: 100}]}\n"),
            (Stated{{"no disturbance", PremiseState::stated_none}}));
}

TEST(Premises, AnOpenLoopAssumesNothingOfItsControl) {
  for (const study::Premise& premise :
       study_of("zerocount: 1\nname: open\nseed: 1\ntrials: 1\ncommand: {torque: {levels: [0.1]}}\n")
           .premises) {
    EXPECT_NE(premise.assumption, "no delay");
    EXPECT_NE(premise.assumption, "no encoder noise");
  }
}

// Where the values that trials rest on come from: what the manifest gives, by whatever key, and the defaults
// that act.

std::map<std::string_view, ValueSource> sources_of(const study::Study& study) {
  std::map<std::string_view, ValueSource> sources;
  for (const SourcedValue& one : value_sources(*study.plan))
    sources[study.plan->table.rows[one.slot].name] = one.source;
  return sources;
}

// Any mixture of keys that are left out, set, drawn, swept or of a condition.
TEST(ValueSources, AValueCountsAsGivenWhereverItStandsInTheManifest) {
  std::mt19937_64 random(5);
  const std::map<std::string, double> keys{{"plant.inertia", 1e-3},   {"friction.k1", 100.0},
                                           {"friction.beta", 9e4},    {"encoder.fine", 8e5},
                                           {"dac.bits", 14.0},        {"amplifier.bandwidth", 800.0},
                                           {"controller.ki", 2.0e-5}, {"verdict.dwell", 0.02}};
  for (int i = 0; i < 40; ++i) {
    std::map<std::string_view, bool> given;
    std::string grid;
    std::string loaded;
    std::vector<std::string> overrides;
    for (const auto& [key, value] : keys) {
      const int how = std::uniform_int_distribution(0, 4)(random);
      given[key] = how > 0;
      if (how == 1) overrides.push_back(fmt::format("{}={}", key, value));
      if (how == 2) overrides.push_back(fmt::format("{}={{choice: [{}]}}", key, value));
      if (how == 3) grid += fmt::format("{}{}: [{}]", grid.empty() ? "" : ", ", key, value);
      if (how == 4) loaded += fmt::format("{}{}: {}", loaded.empty() ? "" : ", ", key, value);
    }
    std::string more;
    if (!grid.empty()) more += "sweep: {grid: {" + grid + "}}\n";
    if (!loaded.empty()) more += "conditions: {plain: {controller.kd: 0}, other: {" + loaded + "}}\n";
    const auto sources = sources_of(study_of(minimal_manifest(more), overrides));
    for (const auto& [key, is_given] : given) {
      // An amplifier without bandwidth is an effect that is absent, not a default that acts.
      if (key == "amplifier.bandwidth" && !is_given) {
        EXPECT_EQ(sources.count(key), 0U);
        continue;
      }
      ASSERT_EQ(sources.count(key), 1U) << key;
      EXPECT_EQ(sources.at(key), is_given ? ValueSource::given : ValueSource::assumed) << key << "\n" << more;
    }
  }
}

TEST(ValueSources, ValuesDerivedFromMeasurementsAreNotCalledAssumed) {
  const auto sources = sources_of(study_of(
      minimal_manifest("friction: {measured: {initial_stiffness: 900, final_stiffness: 100, breakaway: 0.3, "
                       "breakaway_travel: 1.0e-3}}\n")));
  EXPECT_EQ(sources.at("friction.measured.breakaway"), ValueSource::measured);
  for (const char* const follows : {"friction.k1", "friction.k2", "friction.beta", "friction.breakaway"})
    EXPECT_EQ(sources.count(follows), 0U) << follows;
  EXPECT_EQ(sources.at("friction.alpha"), ValueSource::assumed);
}

TEST(ValueSources, DefaultsWithoutEffectAreNotNamed) {
  const auto spring = sources_of(study_of(minimal_manifest("friction: {model: spring}\n")));
  EXPECT_EQ(spring.count("friction.alpha"), 0U);
  EXPECT_EQ(spring.count("friction.sigma0"), 0U);
  EXPECT_EQ(spring.count("friction.k1"), 1U);
  const auto lugre = sources_of(study_of(minimal_manifest("friction: {model: lugre}\n")));
  EXPECT_EQ(lugre.count("friction.k1"), 0U);
  EXPECT_EQ(lugre.at("friction.sigma0"), ValueSource::assumed);
}

}  // namespace
}  // namespace zerocount::rules

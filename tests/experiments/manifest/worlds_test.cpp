// `worlds` in a manifest: the values that all trials of a world share, and what is refused.
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest {
namespace {

const std::vector<std::string> designs_with_worlds{"monte_carlo", "latin_hypercube", "sobol"};

/// A manifest with these values of k1, k2 and beta. Inertia and alpha are drawn for each machine, if there
/// are machines, and the position for each trial.
std::string machines_with(const std::string& k1, const std::string& k2, const std::string& beta) {
  return minimal_manifest(
      "plant: {inertia: {uniform: [5.0e-4, 6.0e-4]}}\n"
      "friction: {k1: " +
      k1 + ", k2: " + k2 + ", beta: " + beta +
      ", alpha: {uniform: [0.1, 0.9]}}\n"
      "initial: {position: {uniform: [0, 6]}}\n"
      "sweep: {grid: {controller.ki: [3.0e-5, 4.0e-5]}}\n");
}

std::string machines_in_worlds() {
  return machines_with("{interval: [90, 130]}", "{uniform: [600, 900], per: world}",
                       "{lognormal: {median: 2.0e5, cv: 0.2}, per: world}");
}

const std::vector<std::string> values_of_worlds{"friction.k1", "friction.k2", "friction.beta"};
const std::vector<std::string> other_values{"plant.inertia", "friction.alpha", "initial.position"};

/// A study with this design.
/// @param worlds number of worlds; 0: none
/// @param machines number of machines; 0: none
study::Study study_with_worlds(const std::string& text, const std::string& design, int worlds, int machines,
                               int trials, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"design=" + design, fmt::format("trials={}", trials)};
  if (worlds > 0) overrides.push_back(fmt::format("worlds={}", worlds));
  if (machines > 0) overrides.push_back(fmt::format("machines={}", machines));
  overrides.insert(overrides.end(), more.begin(), more.end());
  return study_of(text, overrides);
}

std::vector<double> inputs_named(const study::Study& study, const std::vector<std::string>& names,
                                 std::int64_t point, std::int64_t trial) {
  const std::vector<double> inputs = study::study_trial(study, point, trial).inputs;
  std::vector<double> values;
  for (const std::string& name : names) values.push_back(inputs[column_of(study, name)]);
  return values;
}

TEST(Worlds, AllTrialsAndPointsOfAWorldShareItsValues) {
  for (const std::string& design : designs_with_worlds) {
    for (const int machines : {0, 30}) {
      for (const std::string independent : {"false", "true"}) {
        const study::Study study = study_with_worlds(machines_in_worlds(), design, 10, machines, 60,
                                                     {"independent_points=" + independent});
        std::set<std::vector<double>> different;
        for (std::int64_t trial = 0; trial < study.trials; ++trial) {
          EXPECT_EQ(study::group_of(study, study::Grouping::world, trial), trial % 10);
          if (machines > 0) {
            EXPECT_EQ(study::group_of(study, study::Grouping::world, trial),
                      study::group_of(study, study::Grouping::machine, trial) % 10);
          }
          const std::vector<double> of_world = study::group_inputs(study, study::Grouping::world, trial % 10);
          for (std::int64_t point = 0; point < study::point_count(study); ++point)
            EXPECT_EQ(inputs_named(study, values_of_worlds, point, trial), of_world) << design;
          EXPECT_EQ(study::study_trial(study, 1, trial).parameters.friction.uniform.k1, of_world[0]);
          different.insert(of_world);
        }
        EXPECT_EQ(different.size(), 10U) << design;
      }
    }
  }
}

TEST(Worlds, ListTheParametersThatDifferBetweenThem) {
  const study::Study study = study_with_worlds(machines_in_worlds(), "monte_carlo", 10, 30, 60);
  std::vector<std::string> names;
  for (const study::InputColumn& column : study.columns.shared[study::Grouping::world]) {
    EXPECT_EQ(column.level, study::DrawLevel::world);
    names.push_back(column.name);
  }
  EXPECT_EQ(names, values_of_worlds);
  EXPECT_TRUE(study_of(full_manifest()).columns.shared[study::Grouping::world].empty());
}

int stratum(double probability, int strata) {
  return static_cast<int>(static_cast<double>(strata) * probability);
}

double lognormal_probability(double value, double median, double cv) {
  const double score = std::log(value / median) / std::sqrt(std::log1p(cv * cv));
  return 0.5 * std::erfc(-score / std::numbers::sqrt2);
}

// An interval has strata of equal width.
TEST(Worlds, EachWorldHasItsOwnStratumInEveryDesign) {
  for (const std::string& design : designs_with_worlds) {
    for (const int worlds : {2, 7, 30, 64}) {
      for (int seed = 1; seed <= 5; ++seed) {
        for (const int machines : {0, 2 * worlds}) {
          const study::Study study = study_with_worlds(machines_in_worlds(), design, worlds, machines,
                                                       4 * worlds, {fmt::format("seed={}", seed)});
          std::array<std::set<int>, 3> strata;
          for (std::int64_t world = 0; world < worlds; ++world) {
            const std::vector<double> values = study::group_inputs(study, study::Grouping::world, world);
            strata[0].insert(stratum((values.at(0) - 90.0) / 40.0, worlds));
            strata[1].insert(stratum((values.at(1) - 600.0) / 300.0, worlds));
            strata[2].insert(stratum(lognormal_probability(values.at(2), 2.0e5, 0.2), worlds));
          }
          for (const std::set<int>& of_value : strata) {
            EXPECT_EQ(of_value.size(), static_cast<std::size_t>(worlds)) << design << ", seed " << seed;
            EXPECT_EQ(*of_value.begin(), 0);
            EXPECT_EQ(*of_value.rbegin(), worlds - 1);
          }
        }
      }
    }
  }
}

// The order of a Sobol sequence has to change, so that its trials do not depend on the world.
TEST(Worlds, DoNotChangeOtherDraws) {
  for (const std::string design : {"monte_carlo", "latin_hypercube"}) {
    for (const int machines : {0, 30}) {
      for (const std::string independent : {"false", "true"}) {
        const std::vector<std::string> points{"independent_points=" + independent};
        const study::Study with = study_with_worlds(machines_in_worlds(), design, 10, machines, 60, points);
        const study::Study without =
            study_with_worlds(machines_with("110", "750", "2.0e5"), design, 0, machines, 60, points);
        for (std::int64_t trial = 0; trial < 60; ++trial) {
          for (std::int64_t point = 0; point < 2; ++point) {
            EXPECT_EQ(inputs_named(with, other_values, point, trial),
                      inputs_named(without, other_values, point, trial))
                << design << ", machines " << machines << ", trial " << trial;
          }
        }
      }
    }
  }
}

// Worlds would differ by their machines, too, if all machines of a world were in one part of the range: that
// is so for every 16th point of a Sobol sequence. A part stays empty by chance once in three million.
TEST(Worlds, HaveMachinesAndMovesOfTheWholeRange) {
  const std::string text = minimal_manifest(
      "friction: {k1: {uniform: [90, 130]}, k2: {uniform: [600, 900]}, "
      "beta: {interval: [1.0e5, 2.0e5]}}\n");
  constexpr int worlds = 16;
  constexpr int of_each = 128;
  for (const std::string& design : designs_with_worlds) {
    for (const int machines : {0, worlds * of_each}) {
      const study::Study study = study_with_worlds(text, design, worlds, machines, worlds * of_each);
      std::array<std::set<std::pair<std::int64_t, int>>, 2> parts;
      for (std::int64_t trial = 0; trial < study.trials; ++trial) {
        const std::vector<double> values = inputs_named(study, {"friction.k1", "friction.k2"}, 0, trial);
        const std::int64_t world = study::group_of(study, study::Grouping::world, trial);
        parts[0].emplace(world, stratum((values[0] - 90.0) / 40.0, 8));
        parts[1].emplace(world, stratum((values[1] - 600.0) / 300.0, 8));
      }
      EXPECT_EQ(parts[0].size(), 8U * worlds) << design << ", machines " << machines;
      EXPECT_EQ(parts[1].size(), 8U * worlds) << design << ", machines " << machines;
    }
  }
}

TEST(Worlds, TakeRowsOfSamplesEquallyOften) {
  std::string table = "friction.k1,friction.k2\n";
  for (int row = 0; row < 8; ++row) table += fmt::format("{},{}\n", 100 + row, 700 - 10 * row);
  for (const std::string& design : designs_with_worlds) {
    const study::Study study =
        parse_study(minimal_manifest("worlds: 16\nsamples: {file: p.csv, per: world}\n"), "m.yaml",
                    {"trials=48", "design=" + design}, sections::known_external_inputs(nullptr, table));
    EXPECT_EQ(study.samples->level, study::DrawLevel::world);
    EXPECT_EQ(study::samples_text(*study.samples),
              "friction.k1, friction.k2: a row of p.csv (8 draws) for each world");
    std::map<double, int> worlds_of_row;
    for (std::int64_t trial = 0; trial < 48; ++trial) {
      const std::vector<double> row = inputs_named(study, {"friction.k1", "friction.k2"}, 0, trial);
      EXPECT_EQ(row, study::group_inputs(study, study::Grouping::world, trial % 16));
      EXPECT_EQ(row[1], 700.0 - 10.0 * (row[0] - 100.0));
      if (trial < 16) ++worlds_of_row[row[0]];
    }
    EXPECT_EQ(worlds_of_row.size(), 8U) << design;
    for (const auto& [row, count] : worlds_of_row) EXPECT_EQ(count, 2) << design << ", k1 " << row;
  }
}

TEST(Interval, IsDrawnForEachWorldByDefault) {
  const auto with = [](const std::string& k1) {
    return study_of(minimal_manifest("worlds: 5\nfriction: {k1: " + k1 + "}\n"));
  };
  const study::Study study = with("{interval: [90, 130]}");
  ASSERT_EQ(study.columns.inputs.size(), 1U);
  EXPECT_EQ(study.columns.inputs[0].level, study::DrawLevel::world);
  for (std::int64_t world = 0; world < 5; ++world) {
    EXPECT_EQ(study::group_inputs(study, study::Grouping::world, world),
              study::group_inputs(with("{interval: [90, 130], per: world}"), study::Grouping::world, world));
    EXPECT_EQ(study::group_inputs(study, study::Grouping::world, world),
              study::group_inputs(with("{uniform: [90, 130], per: world}"), study::Grouping::world, world));
  }
}

TEST(Worlds, WithoutADifferenceGetAWarning) {
  const auto warnings = [](const std::string& k1) {
    return study_of(minimal_manifest("worlds: «5»\nfriction: {k1: " + k1 + "}\n")).warnings;
  };
  EXPECT_TRUE(has_faults(warnings("{uniform: [90, 130]}"), "«»: worlds | all alike | per: world"));
  EXPECT_EQ(warnings("{uniform: [90, 130], per: world}"), std::vector<std::string>{});
}

struct WorldsRefusal {
  const char* lines;
  const char* faults;
};

class RefusedWorlds : public ::testing::TestWithParam<WorldsRefusal> {};

TEST_P(RefusedWorlds, MessageGivesTheReason) {
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest(GetParam().lines)), GetParam().faults));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedWorlds,
    ::testing::Values(
        WorldsRefusal{"worlds: «1»", "«»: worlds | '1'"},
        WorldsRefusal{"friction: {k1: {uniform: [90, 130], per: «world»}}",
                      "«»: friction.k1.per | has no worlds | the key worlds"},
        WorldsRefusal{"friction: {k1: «{interval: [90, 130]}»}",
                      "«»: friction.k1 | drawn for each world | the key worlds, or uniform"},
        WorldsRefusal{"worlds: 5\nfriction: {k1: {interval: [90, 130], per: «trial»}}",
                      "«»: friction.k1.per | no distribution to draw from | world, or uniform"},
        WorldsRefusal{"worlds: 5\nfriction: {k1: {interval: «[130, 90]»}}", "«»: friction.k1.interval"},
        WorldsRefusal{"worlds: 5\nfriction: {k1: {profile: {mean: «{interval: [90, 130]}», cv: 0.1, "
                      "correlation_length: 0.2}}}",
                      "«»: friction.k1.profile.mean | an interval is drawn for each world"},
        WorldsRefusal{"worlds: 5\nfriction: {k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.2}, "
                      "per: «world»}}",
                      "«»: friction.k1.per | belongs to a rotor | study or machine"},
        WorldsRefusal{"machines: 5\nworlds: «2»\nfriction: {k1: {interval: [90, 130]}}",
                      "«»: worlds | 5 machines cannot be divided equally among 2 worlds | 4 or 6 machines"},
        WorldsRefusal{"worlds: «11»\nfriction: {k1: {interval: [90, 130]}}",
                      "«»: worlds | only 10 trials | at most 10"},
        WorldsRefusal{"design: «saltelli»\nworlds: 5\nfriction: {k1: {interval: [90, 130]}}",
                      "«»: design | the trials of a world share factors | with worlds"}));

}  // namespace
}  // namespace zerocount::manifest

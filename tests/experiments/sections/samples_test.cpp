// `samples` in a manifest: joint draws of several parameters, and what is refused.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

using Draw = std::vector<double>;

study::Study study_with(const std::string& table, const std::string& more) {
  return manifest::parse_study(minimal_manifest(more), "m.yaml", {}, known_companions(nullptr, table));
}

std::string refusal_with(const std::string& table, const std::string& more) {
  try {
    study_with(table, more);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

/// A table of k1 and k2, each row different.
struct RandomTable {
  explicit RandomTable(std::size_t rows, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> k1(50.0, 150.0);
    std::uniform_real_distribution<double> k2(400.0, 1200.0);
    for (std::size_t row = 0; row < rows; ++row) {
      draws.push_back({k1(generator), k2(generator)});
      text += fmt::format("{},{}\n", draws.back()[0], draws.back()[1]);
    }
  }
  std::string text{"friction.k1,friction.k2\n"};
  std::vector<Draw> draws;
};

Draw inputs_of(const study::Study& study, std::int64_t trial) {
  const std::vector<double> inputs = study::study_trial(study, 0, trial).inputs;
  return {inputs[column_of(study, "friction.k1")], inputs[column_of(study, "friction.k2")]};
}

std::map<Draw, std::int64_t> counts_of(const study::Study& study) {
  std::map<Draw, std::int64_t> counts;
  for (std::int64_t trial = 0; trial < study.trials; ++trial) ++counts[inputs_of(study, trial)];
  return counts;
}

TEST(Samples, AreDrawnAsWholeRows) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const RandomTable table(1 + seed * 7 % 40, seed);
    const study::Study study = study_with(table.text, "samples: p.csv\n");
    for (const auto& [draw, count] : counts_of(study))
      EXPECT_NE(std::find(table.draws.begin(), table.draws.end(), draw), table.draws.end());
  }
}

TEST(Samples, AreEquallyLikely) {
  const RandomTable table(10, 5);
  const study::Study study = manifest::parse_study(minimal_manifest("samples: p.csv\n"), "m.yaml",
                                                   {"trials=20000"}, known_companions(nullptr, table.text));
  double chi_squared = 0.0;
  for (const auto& [draw, count] : counts_of(study)) {
    const double expected = 2000.0;
    chi_squared +=
        (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
  }
  EXPECT_LT(chi_squared, 27.9) << "the 99.9 % quantile with 9 degrees of freedom";
}

class EvenDesigns : public testing::TestWithParam<const char*> {};

TEST_P(EvenDesigns, UseEveryRowEquallyOften) {
  const RandomTable table(16, 3);
  const study::Study study = manifest::parse_study(minimal_manifest("samples: p.csv\n"), "m.yaml",
                                                   {"trials=64", std::string("design=") + GetParam()},
                                                   known_companions(nullptr, table.text));
  const auto counts = counts_of(study);
  EXPECT_EQ(counts.size(), 16U);
  for (const auto& [draw, count] : counts) EXPECT_EQ(count, 4);
}

INSTANTIATE_TEST_SUITE_P(Samples, EvenDesigns, testing::Values("latin_hypercube", "sobol"));

TEST(Samples, BelongToTheRigsWithRigs) {
  const RandomTable table(30, 8);
  const study::Study study =
      manifest::parse_study(minimal_manifest("samples: p.csv\n"), "m.yaml", {"trials=40", "rigs=10"},
                            known_companions(nullptr, table.text));
  EXPECT_EQ(study.samples->level, study::DrawLevel::rig);
  for (std::int64_t trial = 10; trial < 40; ++trial)
    EXPECT_EQ(inputs_of(study, trial), inputs_of(study, trial % 10));
  for (std::int64_t rig = 0; rig < 10; ++rig) EXPECT_EQ(study::rig_inputs(study, rig), inputs_of(study, rig));
}

TEST(Samples, CanBeDrawnForEveryTrialWithRigs) {
  const RandomTable table(1000, 8);
  const study::Study study =
      manifest::parse_study(minimal_manifest("samples: {file: p.csv, per: trial}\n"), "m.yaml",
                            {"trials=40", "rigs=10"}, known_companions(nullptr, table.text));
  EXPECT_GT(counts_of(study).size(), 30U);
}

TEST(Samples, HaveTheFormOfOtherPrograms) {
  const study::Study study = study_with(
      "\xEF\xBB\xBF# k1 and k2\r\n\"friction.k1\", friction.k2\r\n\r\n 90 ,7.0e2\r\n", "samples: p.csv\n");
  EXPECT_EQ(inputs_of(study, 0), (Draw{90.0, 700.0}));
  EXPECT_EQ(study::samples_text(*study.samples),
            "friction.k1, friction.k2: a row of p.csv (1 draw) for each trial");
}

TEST(Samples, ArePartOfTheStudysHash) {
  const auto hash = [](const char* table) { return study_with(table, "samples: p.csv\n").study_sha256; };
  EXPECT_EQ(hash("friction.k1\n100\n"), hash("friction.k1\n100\n"));
  EXPECT_NE(hash("friction.k1\n100\n"), hash("friction.k1\n101\n"));
}

struct SamplesRefusal {
  const char* table;
  const char* lines;
  const char* message;
};

class RefusedSamples : public testing::TestWithParam<SamplesRefusal> {};

TEST_P(RefusedSamples, SayWhy) {
  EXPECT_TRUE(has_faults(refusal_with(GetParam().table, GetParam().lines), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedSamples,
    testing::Values(
        SamplesRefusal{"friction.k1\n", "samples: p.csv", "p.csv:1:1: samples | has 0 draws"},
        SamplesRefusal{"friction.k1,friction.k2\n1,2\n3\n", "samples: p.csv",
                       "p.csv:3:1: samples | the row has 1 cells"},
        SamplesRefusal{"friction.k1,\n1,2\n", "samples: p.csv", "p.csv:1:13: samples | the column"},
        SamplesRefusal{"friction.k1,friction.k1\n1,2\n", "samples: p.csv",
                       "p.csv:1:13: friction.k1 | duplicate"},
        SamplesRefusal{"friction.kk\n1\n", "samples: p.csv", "p.csv:1:1: friction.kk | unknown parameter"},
        SamplesRefusal{"trials\n1\n", "samples: p.csv", "p.csv:1:1: trials | unknown parameter"},
        SamplesRefusal{"friction.k1\n100\nfast\n", "samples: p.csv",
                       "p.csv:3:1: friction.k1.choice.1 | is not a number"},
        SamplesRefusal{"friction.k1\n100\n-5\n", "samples: p.csv",
                       "p.csv:1:1: friction.k1.choice | (0, inf)"},
        SamplesRefusal{"friction.k1\n100\n", "friction: {k1: 90}\nsamples: p.csv",
                       "p.csv:1:1: friction.k1 | the column"},
        SamplesRefusal{"friction.k1\n100\n", "sweep: {grid: {friction.k1: [90, 100]}}\nsamples: p.csv",
                       "p.csv:1:1: friction.k1 | the column"},
        SamplesRefusal{"friction.k1,initial.position\n100,1\n", "rigs: 2\nsamples: p.csv",
                       "7:10: samples | per: rig"},
        SamplesRefusal{"friction.k1\n100\n", "samples: {per: rig}", "6:10: samples | the key 'file'"},
        SamplesRefusal{"friction.k1\n100\n", "samples: {file: p.csv, per: rig}",
                       "6:29: friction.k1.per | has no rigs"},
        SamplesRefusal{"friction.k1\n100\n", "samples: 5", "6:10: samples | truth value"},
        SamplesRefusal{"friction.k1\n100\n101\n",
                       "friction: {k2: {uniform: [600, 900]}}\nsamples: p.csv\n"
                       "correlation: [[friction.k1, friction.k2, 0.5]]",
                       "8:16: correlation.0.0 | samples"},
        SamplesRefusal{"friction.k1\n100\n101\n", "design: saltelli\nsamples: p.csv",
                       "7:10: samples | another design"}));

}  // namespace
}  // namespace zerocount::sections

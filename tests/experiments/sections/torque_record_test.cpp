// A recorded torque in a manifest: as a table, and as a list of pairs.
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount::sections {
namespace {

using Files = std::map<std::string, std::string>;

std::string replay(const std::string& torque, const std::string& more = "") {
  return "zerocount: 1\nname: replay\nseed: 1\ntrials: 1\ncommand: {torque: " + torque + more + "}\n";
}

study::Study replayed_study(const std::string& manifest, const Files& files = {}) {
  ExternalInputs external;
  external.samples = [&files](const std::string& path, std::string_view) { return files.at(path); };
  return manifest::parse_study(manifest, "replay.yaml", {}, external);
}

std::string refusal_of_replay(const std::string& manifest, const Files& files = {}) {
  return refusal_by([&] { replayed_study(manifest, files); });
}

const Files table{
    {"record.csv", "time [ms];torque [mN m];count\n# started by hand\n\n100;250;1\n101;-125.5;2\n104;0;5\n"}};

TEST(TorqueFromAFile, EqualsTheListInSiUnits) {
  const study::Study study = replayed_study(replay("{file: record.csv, through: exact}"), table);
  EXPECT_TRUE(study.open_loop);
  EXPECT_EQ(study.moves, 1);
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  ASSERT_NE(trial.command.torque.record, nullptr);
  const trial::TorqueRecord& record = *trial.command.torque.record;
  ASSERT_EQ(record.time.size(), 3u);
  EXPECT_EQ(record.time[0], 0.0);
  EXPECT_NEAR(record.time[2], 0.004, 1e-15);
  EXPECT_DOUBLE_EQ(record.torque[0], 0.25);
  EXPECT_DOUBLE_EQ(record.torque[1], -0.1255);
  EXPECT_EQ(trial.command.torque.through, trial::TorquePath::exact);
  EXPECT_NEAR(trial.command.hold, 0.007, 1e-12) << "as long as the record";
  EXPECT_EQ(trial::samples_of_trial(trial), 14);
  const study::Study again =
      manifest::parse_study(study.manifest.text, "replay.yaml", study.manifest.overrides, {});
  EXPECT_EQ(again.study_sha256, study.study_sha256) << "the study is whole without the file";
}

TEST(TorqueFromAFile, CanBeShortenedAndHasTheUnitsOfTheAxis) {
  const Files force{{"f.csv", "t,force [kN]\n0,1\n0.5,2\n"}};
  const std::string axis =
      "axis: linear\nplant: {inertia: 95, sliding_damping: 200}\nfriction: {model: coulomb, breakaway: 20, "
      "coulomb_ratio: 1}\n"
      "encoder: {resolution: 5.0e-8}\n";
  const std::string exact = "{file: f.csv, through: exact}";
  const study::Study study = replayed_study(replay(exact, ", hold: 0.75") + axis, force);
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(trial.command.torque.record->torque[1], 2000.0);
  EXPECT_EQ(trial.command.hold, 0.75);
  const std::string torque =
      refusal_of_replay(replay(exact) + axis, {{"f.csv", "t,force [N m]\n0,1\n1,2\n"}});
  EXPECT_TRUE(says(
      torque, "f.csv:1:1: command.torque.file: the column force has the unit 'N m'; expected N, mN or kN"));
}

TEST(TorqueFromAFile, MistakesAreReportedWithTheirPlace) {
  struct Case {
    std::string text;
    std::string expected;
  };
  const std::vector<Case> cases{
      {"t,torque\n0,1\n0.1,2\n«0.1,3»\n",
       "record.csv:«»: command.torque.file: the time 0.1 s is not after the one before it, 0.1 s; expected "
       "increasing times"},
      {"t,torque [V]\n0,1\n0.1,2\n",
       "record.csv:1:1: command.torque.file: the column torque has the unit 'V'; expected N m or mN m"},
      {"t,force\n0,1\n0.1,2\n",
       "record.csv:1:1: command.torque.file: the table has no column torque; expected a header such as t "
       "[s], "
       "torque [N m]"},
      {"t,torque\n0,1\n«0.1,nan»\n",
       "record.csv:«»: command.torque.file: 'nan' is not a number; expected a finite number"},
      {"t,torque\n0,1\n«0.1»\n", "record.csv:«»: command.torque.file: a row of 1 cells"},
      {"t,torque\n0,1\n", "record.csv:1:1: command.torque.file: the table has 1 rows; expected a header"},
      {"", "record.csv:1:1: command.torque.file: the table is empty; expected a header such as t [s]"},
  };
  for (const Case& one : cases) {
    const MarkedText record = marked_text(one.text);
    const std::string found = with_marks(
        refusal_of_replay(replay("{file: record.csv}"), {{"record.csv", record.text}}), "record.csv", record);
    EXPECT_EQ(found.find(one.expected), 0) << found << "\n" << one.expected;
    EXPECT_EQ(found.find('\n'), std::string::npos) << "nothing follows from it: " << found;
  }
  const std::string longer = refusal_of_replay(replay("{file: record.csv}", ", hold: 0.008"), table);
  EXPECT_TRUE(says(longer,
                   "command.hold: the record of command.torque.file lasts 0.007 s, and the move can take "
                   "0.008 s; expected at most the record"));
  const std::string both = refusal_of_replay(replay("{file: record.csv, levels: [1]}"), table);
  EXPECT_TRUE(says(both, "command.torque.levels: it has no effect: command.torque.file defines the torque"));
  EXPECT_TRUE(says(refusal_of_replay(replay("{file: [[0, 1], [2, 2], [2, 1]]}")), "2 is not above 2"));
  EXPECT_TRUE(
      says(refusal_of_replay(replay("{file: [[0.5, 1], [1, 2]]}")), "found the time 0.5 s; expected 0"));
}

TEST(TorqueFromAFile, OneMistakeGivesOneMessage) {
  for (const std::string file : {"[[0, 1]]", "[[0, 1], [1, .inf]]", "[[0, 1, 2], [1, 2, 3]]", "[[0, 1], 2]",
                                 "7", "{}", "[]", "[[0, 1], [0, 1]]"}) {
    const std::string found = refusal_of_replay(replay("{file: " + file + "}"));
    EXPECT_TRUE(says(found, "command.torque.file")) << file << ": " << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << file << ": " << found;
  }
}

TEST(TorqueFromAFile, ATorqueBeyondTheConverterGivesAWarning) {
  for (const std::string file : {"record.csv", "[[0, 1], [0.1, 1.0e6]]"}) {
    const study::Study study = replayed_study(replay("{file: " + file + "}", ", hold: 0.1"),
                                              {{"record.csv", "t,torque\n0,1\n0.1,1e6\n"}});
    ASSERT_EQ(study.warnings.size(), 1u) << file;
    EXPECT_TRUE(
        says(study.warnings[0], "command.torque.file: 1000000 N m can be outside the converter's range"));
    EXPECT_FALSE(says(study.warnings[0], "1:1:")) << "not the place of the key";
  }
}

TEST(TorqueFromAFile, AMissingFileIsDescribedAsATableOfTorques) {
  ExternalInputs external;
  std::string expected;
  external.samples = [&](const std::string&, std::string_view what) {
    expected = what;
    return table.begin()->second;
  };
  manifest::parse_study(replay("{file: record.csv}"), "replay.yaml", {}, external);
  EXPECT_EQ(expected, "a table of torques");
}

// Spectra of vibration in manifests: as lists, and as files of points.

std::string with_spectrum(const std::string& spectrum) {
  return "zerocount: 1\nname: floor\nseed: 1\ntrials: 2\ncommand: {targets: [3], hold: 0.1}\n"
         "disturbance:\n  vibration:\n    - {amplitude: 1.0e-4, frequency: 50, phase: 0}\n    - {spectrum: " +
         spectrum + ", lines: 7}\n";
}

study::Study study_with(const std::string& spectrum, const std::map<std::string, std::string>& files = {}) {
  ExternalInputs external;
  external.samples = [&files](const std::string& path, std::string_view) { return files.at(path); };
  return manifest::parse_study(with_spectrum(spectrum), "floor.yaml", {}, external);
}

std::string error_with(const std::string& spectrum, const std::map<std::string, std::string>& files = {}) {
  return refusal_by([&] { study_with(spectrum, files); });
}

const trial::SpectrumParameters& spectrum_of(const study::Study& study, trial::TrialParameters& parameters) {
  parameters = study::study_trial(study, 0, 0).parameters;
  return *parameters.disturbance.spectra.at(0);
}

TEST(Spectrum, AFileEqualsTheListOfItsPoints) {
  const std::map<std::string, std::string> files{
      {"floor.csv", "frequency;density\n# a comment\n1; 1e-10\n\n10;2.5e-9\n 100;1e-12 \r\n"}};
  trial::TrialParameters parameters;
  const study::Study study = study_with("floor.csv", files);
  const trial::SpectrumParameters& spectrum = spectrum_of(study, parameters);
  ASSERT_EQ(spectrum.density.size(), 3u);
  EXPECT_EQ(spectrum.density[1].frequency, 10.0);
  EXPECT_EQ(spectrum.density[1].density, 2.5e-9);
  EXPECT_EQ(spectrum.density[2].density, 1e-12);
  EXPECT_EQ(spectrum.lines, 7);
  // The study is whole without the file: its overrides hold the points.
  const study::Study again =
      manifest::parse_study(study.manifest.text, "floor.yaml", study.manifest.overrides, {});
  EXPECT_EQ(again.study_sha256, study.study_sha256);
  // Another table makes another study.
  const study::Study other = study_with("floor.csv", {{"floor.csv", "1, 1e-10\n100, 1e-12\n"}});
  EXPECT_NE(other.study_sha256, study.study_sha256);
}

TEST(Spectrum, ABadFileIsRefusedWithItsLine) {
  EXPECT_TRUE(says(error_with("floor.csv", {{"floor.csv", "f, S\n1, 1e-10\n2; x\n"}}), "floor.csv:3:1"));
  EXPECT_TRUE(says(error_with("floor.csv", {{"floor.csv", "# nothing\n"}}), "floor.csv:1:1"));
  EXPECT_TRUE(
      says(error_with("floor.csv", {{"floor.csv", "10, 1\n1, 1\n"}}), "disturbance.vibration.1.spectrum"));
}

TEST(Spectrum, AbsurdSizesAreRefused) {
  EXPECT_TRUE(says(error_with("[[1, 1.0e+300], [2, 1]]"), "floor.yaml:9"));
  EXPECT_TRUE(says(error_with("[[1, 1], [1.0e+300, 1]]"), "floor.yaml:9"));
  EXPECT_TRUE(says(error_with("[[2, 1], [1, 1]]"), "spectrum.1.0: 1 is not above 2"));
}

// `samples` in a manifest: joint draws of several parameters, and what is refused.

using Draw = std::vector<double>;

study::Study study_with_samples(const std::string& table, const std::string& more) {
  return study_of(minimal_manifest(more), {}, known_external_inputs(nullptr, table));
}

/// The message with which the study is refused. The table p.csv and the manifest may have marks.
std::string refusal_with(const std::string& table, const std::string& more) {
  const MarkedText marked = marked_text(table);
  const std::string message =
      refusal_of(minimal_manifest(more), {}, known_external_inputs(nullptr, marked.text));
  return with_marks(message, "p.csv", marked);
}

/// A random table of joint draws of k1 and k2; no two rows are equal.
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
    const study::Study study = study_with_samples(table.text, "samples: p.csv\n");
    for (const auto& [draw, count] : counts_of(study))
      EXPECT_NE(std::find(table.draws.begin(), table.draws.end(), draw), table.draws.end());
  }
}

TEST(Samples, AreEquallyLikely) {
  const RandomTable table(10, 5);
  const study::Study study =
      manifest::parse_study(minimal_manifest("samples: p.csv\n"), "m.yaml", {"trials=20000"},
                            known_external_inputs(nullptr, table.text));
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
                                                   known_external_inputs(nullptr, table.text));
  const auto counts = counts_of(study);
  EXPECT_EQ(counts.size(), 16U);
  for (const auto& [draw, count] : counts) EXPECT_EQ(count, 4);
}

INSTANTIATE_TEST_SUITE_P(Samples, EvenDesigns, testing::Values("latin_hypercube", "sobol"));

TEST(Samples, AreDrawnPerMachineIfThereAreMachines) {
  const RandomTable table(30, 8);
  const study::Study study =
      manifest::parse_study(minimal_manifest("samples: p.csv\n"), "m.yaml", {"trials=40", "machines=10"},
                            known_external_inputs(nullptr, table.text));
  EXPECT_EQ(study.samples->level, study::DrawLevel::machine);
  for (std::int64_t trial = 10; trial < 40; ++trial)
    EXPECT_EQ(inputs_of(study, trial), inputs_of(study, trial % 10));
  for (std::int64_t machine = 0; machine < 10; ++machine)
    EXPECT_EQ(study::group_inputs(study, study::Grouping::machine, machine), inputs_of(study, machine));
}

TEST(Samples, CanBeDrawnForEveryTrialWithMachines) {
  const RandomTable table(1000, 8);
  const study::Study study =
      manifest::parse_study(minimal_manifest("samples: {file: p.csv, per: trial}\n"), "m.yaml",
                            {"trials=40", "machines=10"}, known_external_inputs(nullptr, table.text));
  EXPECT_GT(counts_of(study).size(), 30U);
}

TEST(Samples, AreReadInTheFormatsOfOtherPrograms) {
  const study::Study study = study_with_samples(
      "\xEF\xBB\xBF# k1 and k2\r\n\"friction.k1\", friction.k2\r\n\r\n 90 ,7.0e2\r\n", "samples: p.csv\n");
  EXPECT_EQ(inputs_of(study, 0), (Draw{90.0, 700.0}));
  EXPECT_EQ(study::samples_text(*study.samples),
            "friction.k1, friction.k2: a row of p.csv (1 draw) for each trial");
}

TEST(Samples, ChangeTheHashOfTheStudy) {
  const auto hash = [](const char* table) {
    return study_with_samples(table, "samples: p.csv\n").study_sha256;
  };
  EXPECT_EQ(hash("friction.k1\n100\n"), hash("friction.k1\n100\n"));
  EXPECT_NE(hash("friction.k1\n100\n"), hash("friction.k1\n101\n"));
}

struct SamplesRefusal {
  const char* table;
  const char* lines;
  const char* message;
};

class RefusedSamples : public testing::TestWithParam<SamplesRefusal> {};

TEST_P(RefusedSamples, MessageGivesTheReason) {
  EXPECT_TRUE(has_faults(refusal_with(GetParam().table, GetParam().lines), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    , RefusedSamples,
    testing::Values(
        SamplesRefusal{"friction.k1\n", "samples: p.csv", "p.csv:1:1: samples | has 0 draws"},
        SamplesRefusal{"friction.k1,friction.k2\n1,2\n«3»\n", "samples: p.csv",
                       "p.csv:«»: samples | a row of 1 cells"},
        SamplesRefusal{"friction.k1,«»\n1,2\n", "samples: p.csv", "p.csv:«»: samples | the column"},
        SamplesRefusal{"friction.k1,«friction.k1»\n1,2\n", "samples: p.csv",
                       "p.csv:«»: samples | two columns are named 'friction.k1'"},
        SamplesRefusal{"friction.kk\n1\n", "samples: p.csv", "p.csv:1:1: friction.kk | unknown parameter"},
        SamplesRefusal{"trials\n1\n", "samples: p.csv", "p.csv:1:1: trials | unknown parameter"},
        SamplesRefusal{"friction.k1\n100\n«fast»\n", "samples: p.csv",
                       "p.csv:«»: friction.k1.choice.1 | is not a number"},
        SamplesRefusal{"friction.k1\n100\n-5\n", "samples: p.csv",
                       "p.csv:1:1: friction.k1.choice | (0, inf)"},
        SamplesRefusal{"friction.k1\n100\n", "friction: {k1: 90}\nsamples: p.csv",
                       "p.csv:1:1: friction.k1 | the column"},
        SamplesRefusal{"friction.k1\n100\n", "sweep: {grid: {friction.k1: [90, 100]}}\nsamples: p.csv",
                       "p.csv:1:1: friction.k1 | the column"},
        SamplesRefusal{"friction.k1,initial.position\n100,1\n", "machines: 2\nsamples: «p.csv»",
                       "«»: samples | per: machine"},
        SamplesRefusal{"friction.k1\n100\n", "samples: «{per: machine}»", "«»: samples.file | missing"},
        SamplesRefusal{"friction.k1\n100\n", "samples: {file: p.csv, per: «machine»}",
                       "«»: friction.k1.per | has no machines"},
        SamplesRefusal{"friction.k1\n100\n", "samples: «5»", "«»: samples | truth value"},
        SamplesRefusal{"friction.k1\n100\n101\n",
                       "friction: {k2: {uniform: [600, 900]}}\nsamples: p.csv\n"
                       "correlation: [[«friction.k1», friction.k2, 0.5]]",
                       "«»: correlation.0.0 | samples"},
        SamplesRefusal{"friction.k1\n100\n101\n", "design: saltelli\nsamples: «p.csv»",
                       "«»: samples | another design"}));

}  // namespace
}  // namespace zerocount::sections

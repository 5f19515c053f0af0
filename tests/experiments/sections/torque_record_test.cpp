// A recorded torque in a manifest: as a table, and as a list of pairs.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/says.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

using Files = std::map<std::string, std::string>;

std::string replay(const std::string& torque, const std::string& more = "") {
  return "zerocount: 1\nname: replay\nseed: 1\ntrials: 1\ncommand: {torque: " + torque + more + "}\n";
}

study::Study replayed_study(const std::string& manifest, const Files& files = {}) {
  Companions companions;
  companions.samples = [&files](const std::string& path, std::string_view) { return files.at(path); };
  return manifest::parse_study(manifest, "replay.yaml", {}, companions);
}

std::string refusal_of_replay(const std::string& manifest, const Files& files = {}) {
  try {
    replayed_study(manifest, files);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_input);
    return failure.what();
  }
  return "";
}

const Files table{
    {"record.csv", "time [ms];torque [mN m];count\n# started by hand\n\n100;250;1\n101;-125.5;2\n104;0;5\n"}};

TEST(TorqueOfAFile, IsThatOfTheListInSiUnits) {
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

TEST(TorqueOfAFile, MayBeShortenedAndHasTheUnitsOfTheAxis) {
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

TEST(TorqueOfAFile, FaultsHaveTheirPlace) {
  struct Case {
    std::string text;
    std::string expected;
  };
  const std::vector<Case> cases{
      {"t,torque\n0,1\n0.1,2\n0.1,3\n",
       "record.csv:4:1: command.torque.file: the time 0.1 s is not after the one before it, 0.1 s; expected "
       "increasing times"},
      {"t,torque [V]\n0,1\n0.1,2\n",
       "record.csv:1:1: command.torque.file: the column torque has the unit 'V'; expected N m or mN m"},
      {"t,force\n0,1\n0.1,2\n",
       "record.csv:1:1: command.torque.file: the table has no column torque; expected a header such as t "
       "[s], "
       "torque [N m]"},
      {"t,torque\n0,1\n0.1,nan\n",
       "record.csv:3:1: command.torque.file: 'nan' is not a number; expected a finite number"},
      {"t,torque\n0,1\n0.1\n", "record.csv:3:1: command.torque.file: the row has 1 cells"},
      {"t,torque\n0,1\n", "record.csv:1:1: command.torque.file: the table has 1 rows; expected a header"},
      {"", "record.csv:1:1: command.torque.file: the table has 0 rows"},
  };
  for (const Case& one : cases) {
    const std::string found = refusal_of_replay(replay("{file: record.csv}"), {{"record.csv", one.text}});
    EXPECT_EQ(found.find(one.expected), 0) << found << "\n" << one.expected;
    EXPECT_EQ(found.find('\n'), std::string::npos) << "nothing follows from it: " << found;
  }
  const std::string longer = refusal_of_replay(replay("{file: record.csv}", ", hold: 0.008"), table);
  EXPECT_TRUE(says(longer,
                   "command.hold: the record of command.torque.file lasts 0.007 s, and the move can take "
                   "0.008 s; expected at most the record"));
  const std::string both = refusal_of_replay(replay("{file: record.csv, levels: [1]}"), table);
  EXPECT_TRUE(says(both, "command.torque.levels: it has no effect: command.torque.file defines the torque"));
  EXPECT_TRUE(
      says(refusal_of_replay(replay("{file: [[0, 1], [0.5, 2], [0.5, 1]]}")), "found the time 0.5 s"));
  EXPECT_TRUE(
      says(refusal_of_replay(replay("{file: [[0.5, 1], [1, 2]]}")), "found the time 0.5 s; expected 0"));
}

TEST(TorqueOfAFile, OneFaultIsOneMessage) {
  for (const std::string file : {"[[0, 1]]", "[[0, 1], [1, .inf]]", "[[0, 1, 2], [1, 2, 3]]", "[[0, 1], 2]",
                                 "7", "{}", "[]", "[[0, 1], [0, 1]]"}) {
    const std::string found = refusal_of_replay(replay("{file: " + file + "}"));
    EXPECT_TRUE(says(found, "command.torque.file")) << file << ": " << found;
    EXPECT_EQ(found.find('\n'), std::string::npos) << file << ": " << found;
  }
}

TEST(TorqueOfAFile, BeyondTheConverterHasItsWarning) {
  for (const std::string file : {"record.csv", "[[0, 1], [0.1, 1.0e6]]"}) {
    const study::Study study = replayed_study(replay("{file: " + file + "}", ", hold: 0.1"),
                                              {{"record.csv", "t,torque\n0,1\n0.1,1e6\n"}});
    ASSERT_EQ(study.warnings.size(), 1u) << file;
    EXPECT_TRUE(
        says(study.warnings[0], "command.torque.file: 1000000 N m can be outside the converter's range"));
    EXPECT_FALSE(says(study.warnings[0], "1:1:")) << "not the place of the key";
  }
}

TEST(TorqueOfAFile, SaysWhatIsExpectedInIt) {
  Companions companions;
  std::string expected;
  companions.samples = [&](const std::string&, std::string_view what) {
    expected = what;
    return table.begin()->second;
  };
  manifest::parse_study(replay("{file: record.csv}"), "replay.yaml", {}, companions);
  EXPECT_EQ(expected, "a table of torques");
}

}  // namespace
}  // namespace zerocount::sections

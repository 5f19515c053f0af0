#include "results/reading/export.hpp"

#include "results/layout/header.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// A table without quoted line feeds, [row][column].
std::vector<std::vector<std::string>> read_table(const fs::path& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(read_bytes(path));
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string> cells{""};
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += line[++i];
      } else if (line[i] == '"') {
        quoted = !quoted;
      } else if (line[i] == ',' && !quoted) {
        cells.emplace_back();
      } else {
        cells.back() += line[i];
      }
    }
    rows.push_back(cells);
  }
  return rows;
}

class Export : public ::testing::Test {
 protected:
  TemporaryFolder directory;
  study::Study study = sample_study();
  reading::AllTrialsFile file{write_sample_file(directory.path(), study)};
  fs::path out = directory / "csv";
  std::vector<fs::path> written = reading::export_csv(file, out);
};

TEST_F(Export, WritesEveryTable) {
  std::vector<std::string> names;
  for (const fs::path& path : written) names.push_back(path.filename());
  EXPECT_EQ(names, (std::vector<std::string>{"points.csv", "trials.csv", "outcomes.csv", "jerks.csv",
                                             "profiles.csv", "trace.csv", "levels.csv"}));
  for (const fs::path& path : written) EXPECT_TRUE(fs::exists(path));
}

TEST_F(Export, PointsHaveTheirAxesAndStatistics) {
  const auto rows = read_table(out / "points.csv");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"point", "label", "controller.ki [N m/count]", "case",
                                               "trials", "arrival_time_mean [s]"}));
  EXPECT_EQ(rows[1][2], "nan");
  EXPECT_EQ(rows[3][0], "2");
  EXPECT_EQ(rows[3][1], study.points.labels[2]);
  EXPECT_EQ(std::stod(rows[3][2]), study.points.axes[0].numbers[2]);
  EXPECT_EQ(rows[3][3], study.points.axes[1].texts[2]);
}

TEST_F(Export, TrialsHaveTheirInputs) {
  const auto rows = read_table(out / "trials.csv");
  ASSERT_EQ(rows.size(), 121U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"trial", "point", "index", "friction.k1 [N m/rad]",
                                               "command.targets.0 [count]"}));
  for (std::int64_t row = 0; row < 120; ++row) {
    const std::vector<double> inputs = sample_result(study, row).inputs;
    EXPECT_EQ(
        rows[static_cast<std::size_t>(row) + 1],
        (std::vector<std::string>{std::to_string(row), std::to_string(row / 40), std::to_string(row % 40),
                                  reading::number_text(inputs[0]), reading::number_text(inputs[1])}));
  }
}

TEST_F(Export, OutcomesHaveOneRowPerMoveAndWordsForVerdicts) {
  const auto rows = read_table(out / "outcomes.csv");
  ASSERT_EQ(rows.size(), 241U);
  const std::vector<trial::MoveOutcome> outcomes = file.outcomes(file.rows());
  const std::vector<std::string> words{"zero_count", "one_count", "oscillating",
                                       "nonfinite",  "open_loop", "off_target"};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    EXPECT_EQ(rows[i + 1][0], std::to_string(i / 2));
    EXPECT_EQ(rows[i + 1][1], std::to_string(i % 2));
    EXPECT_EQ(rows[i + 1][2], words[static_cast<std::size_t>(outcomes[i].outcome)]);
    EXPECT_EQ(rows[i + 1][3], outcomes[i].arrived ? "1" : "0");
    EXPECT_EQ(rows[i + 1][5], reading::number_text(outcomes[i].arrival_time));
  }
}

TEST_F(Export, JerksProfilesAndTracesAreComplete) {
  const auto jerks = read_table(out / "jerks.csv");
  EXPECT_EQ(std::ssize(jerks), file.jerk_count() + 1);
  EXPECT_EQ(jerks[0], (std::vector<std::string>{"trial", "move", "onset [s]", "duration [s]",
                                                "magnitude [count]", "direction"}));
  const auto profiles = read_table(out / "profiles.csv");
  EXPECT_EQ(std::ssize(profiles), layout::profile_angles + 1);
  EXPECT_EQ(profiles[0], (std::vector<std::string>{"profile", "theta [rad]", "value", "unit of value"}));
  EXPECT_EQ(profiles[1][0], "friction.k1");
  EXPECT_EQ(profiles[1][3], "N m/rad");
  const auto trace = read_table(out / "trace.csv");
  ASSERT_EQ(std::ssize(trace), file.trace_count() + 1);
  const std::vector<std::string> last{"mode", "reference [count]", "phase", "drive_torque [N m]"};
  EXPECT_EQ((std::vector<std::string>(trace[0].end() - 4, trace[0].end())), last);
  EXPECT_EQ(trace[6][14], "stick");
  EXPECT_EQ(trace[7][14], "slide");
  EXPECT_EQ(trace[7][16], "coarse");
  EXPECT_EQ(trace[8][16], "fine");
}

TEST_F(Export, TablesOfStatisticsHaveOneRowPerPointAndIndex) {
  const auto levels = read_table(out / "levels.csv");
  ASSERT_EQ(levels.size(), 7U);
  EXPECT_EQ(levels[0], (std::vector<std::string>{"point", "move", "torque_max [N m]"}));
  const std::vector<double> expected = sample_table(file).columns[0].values;
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_EQ(levels[row + 1], (std::vector<std::string>{std::to_string(row / 2), std::to_string(row % 2),
                                                         reading::number_text(expected[row])}));
  }
}

TEST_F(Export, NeverOverwrites) {
  expect_failure(ExitCode::bad_input, "points.csv: exists already", [&] { reading::export_csv(file, out); });
}

TEST(ExportOfAPart, HasOnlyItsOwnTrials) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const layout::RowRange rows{30, 25};
  const auto shards = write_sample_shards(directory / "shards", study, rows, 10);
  testing::merge_shards(shards, study, directory / "part.h5", rows, {});
  reading::export_csv(reading::AllTrialsFile(directory / "part.h5", reading::Require::any_part),
                      directory / "csv");
  const auto trials = read_table(directory.path() / "csv" / "trials.csv");
  ASSERT_EQ(trials.size(), 26U);
  EXPECT_EQ(trials[1][0], "30");
  EXPECT_EQ(trials[25][0], "54");
}

TEST(NumberText, ReadsBackToTheSameDouble) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::strtod(reading::number_text(value).c_str(), nullptr), value);
  }
}

TEST(NumberText, IsShortAndWritesNanAndInf) {
  EXPECT_EQ(reading::number_text(0.1), "0.1");
  EXPECT_EQ(reading::number_text(-0.0), "-0");
  EXPECT_EQ(reading::number_text(3.85e-5), "3.85e-05");
  EXPECT_EQ(reading::number_text(0.0005), "0.0005");
  EXPECT_EQ(reading::number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(reading::number_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(reading::number_text(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(CsvFile, QuotesWhatNeedsQuotes) {
  const TemporaryFolder directory;
  reading::CsvFile csv(directory / "a.csv");
  csv.add("plain text");
  csv.add("a,b");
  csv.add("say \"no\"");
  csv.add("two\nlines");
  csv.add("");
  csv.end_row();
  csv.add(0.5);
  csv.add(std::int64_t{-7});
  csv.end_row();
  csv.finish();
  EXPECT_FALSE(std::filesystem::exists(directory / "a.csv")) << "it should have its name only when published";
  csv.publish();
  EXPECT_EQ(read_bytes(directory / "a.csv"),
            "plain text,\"a,b\",\"say \"\"no\"\"\",\"two\nlines\",\n0.5,-7\n");
}

TEST(Csv, AColumnHasItsUnitInBrackets) {
  EXPECT_EQ(reading::head_with_unit("arrival_time", "s"), "arrival_time [s]");
  EXPECT_EQ(reading::head_with_unit("friction.k1", "N m/rad"), "friction.k1 [N m/rad]");
  EXPECT_EQ(reading::head_with_unit("success_rate", "1"), "success_rate");
  EXPECT_EQ(reading::head_with_unit("case", ""), "case");
}

/// Opens the file with the libraries that its users have; their absence is a failure too.
void expect_python_opens(const std::filesystem::path& path, const std::filesystem::path& output) {
  const reading::AllTrialsFile file(path);
  const std::string command = fmt::format(
      "{} {} {} {} {} {} {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_OPEN_WITH_PYTHON, path.string(),
      file.rows().count, file.moves(), file.jerk_count(), file.trace_count(), output.string());
  EXPECT_EQ(std::system(command.c_str()), 0) << read_bytes(output);
  EXPECT_EQ(read_bytes(output), "opened\n");
}

TEST(Python, OpensAFileWithH5pyXarrayAndNetcdf) {
  const TemporaryFolder directory;
  expect_python_opens(write_sample_file(directory.path(), sample_study()), directory / "output");
}

TEST(Python, OpensAFileWithMachines) {
  const TemporaryFolder directory;
  expect_python_opens(write_sample_file(directory.path(), sample_study_with_machines()),
                      directory / "output");
}

TEST(Python, OpensAFileWhoseTablesAreEmpty) {
  const TemporaryFolder directory;
  study::Study study = sample_study(1, 4, 1);
  study.manifest.overrides.clear();
  study.profiles.clear();
  study.points.axes.clear();
  std::vector<shards::TrialResult> results(4);
  for (std::int64_t row = 0; row < 4; ++row) {
    results[static_cast<std::size_t>(row)].row = row;
    results[static_cast<std::size_t>(row)].inputs = {1.0, 2.0};
    results[static_cast<std::size_t>(row)].outcome.moves.resize(1);
  }
  shards::write_shard(directory / "shard.h5", study, {0, std::ssize(results)}, results);
  const std::vector<shards::ShardInfo> shards{{directory / "shard.h5", {0, 4}}};
  testing::merge_shards(shards, study, directory / "empty.h5", {0, 4}, {});
  expect_python_opens(directory / "empty.h5", directory / "output");
}

}  // namespace
}  // namespace zerocount::testing

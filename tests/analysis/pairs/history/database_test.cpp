// The SQLite file of a history: what is added is what is read, and nothing else is taken for it.
#include "analysis/pairs/history/database.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "core/failure/failure.hpp"
#include "tests/analysis/pairs/history/runs.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using history::Addition;

class HistoryDatabase : public ::testing::Test {
 protected:
  std::filesystem::path path() const { return folder_ / "history.sqlite"; }

  void execute(const std::string& sql) const {
    SQLite::Database(path(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(sql);
  }

  /// The message of the failure when the database is read; checks that the failure has this exit code.
  std::string reading_fails(ExitCode code) const {
    return fails(code, [&] { history::read_runs(path()); });
  }

  template <class Action>
  std::string fails(ExitCode code, const Action& action) const {
    const std::string message = refusal_by(action, code);
    EXPECT_TRUE(message.starts_with(path().string())) << message;
    return message;
  }

  TemporaryFolder folder_;
};

// However little the evidence is beyond that of no change.
TEST_F(HistoryDatabase, MonitorEvidenceIsStoredAsTheInverseOfItsProbability) {
  std::string measures;
  for (const char* const evidence : {"0.5", "1.05", "20.0"})
    measures += fmt::format(R"({}{{"measure": "m{}", "unit": "s", "moves": 2.0, "baseline": 1.0,
                                "alarm_at": null, "evidence": {}}})",
                            measures.empty() ? "" : ",", evidence, evidence);
  folder_.write("a.json", R"({"answer": "monitor", "baseline": "b.h5", "baseline_moves": 100, "block": 1,
                             "alarm": 1000.0, "log": "log.csv", "moves": 50, "status": "no alarm",
                             "measures": [)" +
                              measures + "]}");
  const history::RunRecord run = history::monitor_record(folder_ / "a.json").value();
  ASSERT_EQ(run.values.size(), 3U);
  EXPECT_EQ(run.values[0].comparison->p, 1.0);
  EXPECT_EQ(run.values[1].comparison->p, 1.0 / 1.05);
  EXPECT_EQ(run.values[2].comparison->p, 0.05);
}

TEST_F(HistoryDatabase, ReadsBackAddedRunsUnchanged) {
  history::RunRecord compared = run_of_day(2, 0.5);
  compare_with_baseline(compared, 0.25);
  compared.values[0].point = "a 'quoted' \"ü\"; --";
  compared.values[2].bounds = {std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::quiet_NaN()};
  compared.values[1].value = 1.0 / 3.0;
  EXPECT_EQ(history::add_run(path(), compared), Addition::added);
  EXPECT_EQ(history::add_run(path(), run_of_day(1, 0.4)), Addition::added);
  const std::vector<history::RunRecord> runs = history::read_runs(path());
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].created, run_of_day(1, 0.4).created) << "runs are by time, not by the order of adding";
  EXPECT_FALSE(runs[0].comparison);
  const history::RunRecord& read = runs[1];
  EXPECT_EQ(read.study, compared.study);
  EXPECT_EQ(read.series_sha256, compared.series_sha256);
  EXPECT_EQ(read.study_sha256, compared.study_sha256);
  EXPECT_EQ(read.file_sha256, compared.file_sha256);
  EXPECT_EQ(read.seed, compared.seed);
  EXPECT_EQ(read.trials, compared.trials);
  EXPECT_EQ(read.git_commit, compared.git_commit);
  ASSERT_TRUE(read.comparison);
  EXPECT_EQ(read.comparison->baseline_commit, std::string(40, 'b'));
  ASSERT_EQ(read.values.size(), 3U);
  EXPECT_EQ(read.values[0].point, compared.values[0].point);
  EXPECT_EQ(read.values[0].kind, statistics::MeasurementKind::proportion);
  EXPECT_EQ(read.values[1].value, 1.0 / 3.0);
  EXPECT_EQ(read.values[2].kind, statistics::MeasurementKind::mean);
  EXPECT_TRUE(std::isnan(read.values[2].bounds.low));
  EXPECT_EQ(read.values[2].n, 190);
  EXPECT_EQ(read.values[0].comparison->verdict, "equivalent");
  EXPECT_EQ(read.values[0].comparison->p, 0.25);
  EXPECT_EQ(read.values[0].bounds.high, compared.values[0].bounds.high);
}

TEST_F(HistoryDatabase, AddsARunOnce) {
  history::RunRecord run = run_of_day(1, 0.5);
  EXPECT_FALSE(history::has_run(path(), run.file_sha256));
  EXPECT_EQ(history::add_run(path(), run), Addition::added);
  EXPECT_EQ(history::add_run(path(), run), Addition::already_there);
  EXPECT_TRUE(history::has_run(path(), run.file_sha256));
  EXPECT_FALSE(history::has_run(path(), run_of_day(2, 0.5).file_sha256));
  compare_with_baseline(run, 0.5);
  EXPECT_EQ(history::add_run(path(), run), Addition::comparison_added);
  EXPECT_EQ(history::add_run(path(), run), Addition::already_there);
  EXPECT_EQ(history::add_run(path(), run_of_day(1, 0.5)), Addition::already_there);
  ASSERT_EQ(history::read_runs(path()).size(), 1U);
  EXPECT_TRUE(history::read_runs(path())[0].values[1].comparison);
}

TEST_F(HistoryDatabase, LosesNoRunOfManyWriters) {
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 4; ++writer) {
    writers.emplace_back([this, writer] {
      for (int i = 0; i < 10; ++i) history::add_run(path(), run_of_day(10 * writer + i, 0.5));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::vector<history::RunRecord> runs = history::read_runs(path());
  EXPECT_EQ(runs.size(), 40U);
  for (const history::RunRecord& run : runs) EXPECT_EQ(run.values.size(), 3U);
}

TEST_F(HistoryDatabase, RefusesFilesThatAreNotAHistory) {
  EXPECT_TRUE(says(reading_fails(ExitCode::bad_input), "no such history"));
  write_bytes(path(), std::string(4000, 'x'));
  EXPECT_TRUE(says(reading_fails(ExitCode::bad_data), "not a history"));
  fails(ExitCode::bad_data, [&] { history::add_run(path(), run_of_day(1, 0.5)); });
  EXPECT_EQ(read_bytes(path()), std::string(4000, 'x')) << "a foreign file stays as it is";
  std::filesystem::remove(path());
  execute("CREATE TABLE run (id INTEGER)");
  const std::string other = read_bytes(path());
  EXPECT_TRUE(says(reading_fails(ExitCode::bad_data), "not a history"));
  fails(ExitCode::bad_data, [&] { history::add_run(path(), run_of_day(1, 0.5)); });
  EXPECT_EQ(read_bytes(path()), other);
}

TEST_F(HistoryDatabase, RefusesANewerVersion) {
  history::add_run(path(), run_of_day(1, 0.5));
  execute(fmt::format("PRAGMA user_version = {}", history::schema_version + 1));
  EXPECT_TRUE(says(reading_fails(ExitCode::bad_data), "newer"));
  fails(ExitCode::bad_data, [&] { history::add_run(path(), run_of_day(2, 0.5)); });
}

// Whatever bytes are damaged: one error in our words, or the same rows, or other numbers, but no crash.
TEST_F(HistoryDatabase, ReportsDamagedPages) {
  for (int day = 0; day < 40; ++day) history::add_run(path(), run_of_day(day, 0.5));
  const std::string whole = read_bytes(path());
  int found = 0;
  for (std::size_t page = 0; page + 4096 <= whole.size(); page += 4096) {
    std::string damaged = whole;
    damaged.replace(page, 200, 200, '\xff');
    write_bytes(path(), damaged);
    if (!refusal_by([&] { history::read_runs(path()); }, ExitCode::bad_data).empty()) ++found;
  }
  EXPECT_GE(found, static_cast<int>(whole.size() / 4096) - 1);
  write_bytes(path(), whole.substr(0, whole.size() / 2));
  reading_fails(ExitCode::bad_data);
}

TEST_F(HistoryDatabase, GivesUpWaitingForAnotherWriterAfterATime) {
  history::add_run(path(), run_of_day(1, 0.5));
  fails(ExitCode::machine_failed, [&] {
    SQLite::Database other(path(), SQLite::OPEN_READWRITE);
    const SQLite::Transaction holding(other, SQLite::TransactionBehavior::IMMEDIATE);
    history::with_database(path(), 0, {.seconds = 0.05}, [](SQLite::Database& database) {
      const SQLite::Transaction waiting(database, SQLite::TransactionBehavior::IMMEDIATE);
    });
  });
}

TEST_F(HistoryDatabase, ReportsOnceThatItWaits) {
  history::add_run(path(), run_of_day(1, 0.5));
  int said = 0;
  fails(ExitCode::machine_failed, [&] {
    SQLite::Database other(path(), SQLite::OPEN_READWRITE);
    const SQLite::Transaction holding(other, SQLite::TransactionBehavior::EXCLUSIVE);
    history::read_runs(path(), {.seconds = 0.3, .notice = 0.05, .notify = [&] { ++said; }});
  });
  EXPECT_EQ(said, 1);
  history::read_runs(path(), {.seconds = 0.3, .notice = 0.0, .notify = [&] { ++said; }});
  EXPECT_EQ(said, 1);
}

}  // namespace
}  // namespace zerocount::testing

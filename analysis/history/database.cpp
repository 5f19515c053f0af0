#include "analysis/history/database.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "analysis/history/sqlite.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::history {
namespace {

using sqlite::Connection;
using sqlite::Statement;

constexpr double wait_seconds = 60.0;
constexpr std::int64_t application_id = 0x7a636869;  ///< "zchi": tells a history from other SQLite files

constexpr std::string_view schema_sql = R"(
CREATE TABLE run (
  id INTEGER PRIMARY KEY,
  study TEXT NOT NULL,
  series_sha256 TEXT NOT NULL,
  study_sha256 TEXT NOT NULL,
  file_sha256 TEXT NOT NULL UNIQUE,
  seed TEXT NOT NULL,
  trials INTEGER NOT NULL,
  zerocount_version TEXT NOT NULL,
  git_commit TEXT NOT NULL,
  created TEXT NOT NULL,
  verdict TEXT,
  layer TEXT,
  baseline_created TEXT,
  baseline_commit TEXT
) STRICT;
CREATE TABLE value (
  run INTEGER NOT NULL REFERENCES run(id),
  point TEXT NOT NULL,
  measure TEXT NOT NULL,
  unit TEXT NOT NULL,
  kind TEXT NOT NULL CHECK (kind IN ('proportion', 'mean')),
  value REAL NOT NULL,
  low REAL,
  high REAL,
  n INTEGER NOT NULL,
  verdict TEXT,
  baseline REAL,
  effect REAL,
  effect_low REAL,
  effect_high REAL,
  margin REAL,
  p REAL,
  PRIMARY KEY (run, point, measure)
) STRICT;
CREATE VIEW history AS
  SELECT run.created AS date, run.git_commit, run.study, run.series_sha256, run.study_sha256, run.seed, run.trials,
         value.point, value.measure, value.unit, value.value, value.low, value.high, value.n, value.verdict
  FROM value JOIN run ON run.id = value.run ORDER BY run.created, run.id, value.point, value.measure;
)";

std::string_view word_of(statistics::MeasurementKind kind) {
  return kind == statistics::MeasurementKind::proportion ? "proportion" : "mean";
}

[[noreturn]] void fail_foreign(const Connection& connection) {
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: is an SQLite database, but no history of zerocount; name "
                            "another file",
                            connection.path().string()));
}

/// True if the file is a new database, without anything in it.
/// @throws Failure (bad_data) where it is no history that this program knows.
bool is_new(const Connection& connection) {
  const std::int64_t application = connection.whole_number("PRAGMA application_id");
  const std::int64_t version = connection.whole_number("PRAGMA user_version");
  const bool empty = connection.whole_number("SELECT count(*) FROM sqlite_schema") == 0;
  if (empty && application == 0 && version == 0) return true;
  if (application != application_id) fail_foreign(connection);
  if (version > schema_version) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: is a history of version {}, and this program knows up to {}; use a newer "
                              "zerocount",
                              connection.path().string(), version, schema_version));
  }
  if (version != schema_version) connection.fail_damaged();
  return false;
}

void require_undamaged(const Connection& connection) {
  Statement check = connection.prepare("PRAGMA quick_check(1)");
  if (!check.step() || check.text(0) != "ok") connection.fail_damaged();
}

void make_tables(const Connection& connection) {
  connection.execute(std::string(schema_sql));
  connection.execute(fmt::format("PRAGMA application_id = {}", application_id));
  connection.execute(fmt::format("PRAGMA user_version = {}", schema_version));
}

std::int64_t insert_run(const Connection& connection, const RunRecord& run) {
  Statement insert = connection.prepare(
      "INSERT INTO run (study, series_sha256, study_sha256, file_sha256, seed, trials, zerocount_version, "
      "git_commit, created, verdict, layer, baseline_created, baseline_commit) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(0, run.study).bind(1, run.series_sha256).bind(2, run.study_sha256).bind(3, run.file_sha256);
  insert.bind(4, run.seed).bind(5, run.trials).bind(6, run.zerocount_version).bind(7, run.git_commit);
  insert.bind(8, run.created);
  if (const auto& compared = run.comparison) {
    insert.bind(9, compared->verdict).bind(10, compared->layer);
    insert.bind(11, compared->baseline_created).bind(12, compared->baseline_commit);
  }
  insert.step();
  return connection.last_row();
}

void insert_values(const Connection& connection, std::int64_t id, const RunRecord& run) {
  Statement insert = connection.prepare(
      "INSERT INTO value (run, point, measure, unit, kind, value, low, high, n, verdict, baseline, effect, "
      "effect_low, effect_high, margin, p) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const RunValue& value : run.values) {
    insert.bind(0, id).bind(1, value.point).bind(2, value.measure).bind(3, value.unit);
    insert.bind(4, word_of(value.kind)).bind(5, value.value);
    insert.bind(6, value.bounds.low).bind(7, value.bounds.high).bind(8, value.n);
    const ValueComparison compared = value.comparison.value_or(ValueComparison{});
    if (value.comparison) {
      insert.bind(9, compared.verdict);
    } else {
      insert.bind_null(9);
    }
    insert.bind(10, compared.baseline).bind(11, compared.effect).bind(12, compared.bounds.low);
    insert.bind(13, compared.bounds.high).bind(14, compared.margin).bind(15, compared.p);
    insert.step();
    insert.reset();
  }
}

RunRecord run_of(const Statement& row) {
  RunRecord run{row.text(1),  row.text(2), row.text(3), row.text(4), row.text(5),
                row.whole(6), row.text(7), row.text(8), row.text(9)};
  if (!row.is_null(10))
    run.comparison = RunComparison{row.text(10), row.text(11), row.text(12), row.text(13)};
  return run;
}

RunValue value_of(const Statement& row) {
  RunValue value{row.text(1), row.text(2), row.text(3)};
  if (row.text(4) == word_of(statistics::MeasurementKind::proportion))
    value.kind = statistics::MeasurementKind::proportion;
  value.value = row.number(5);
  value.bounds = {row.number(6), row.number(7)};
  value.n = row.whole(8);
  if (row.is_null(9)) return value;
  value.comparison =
      ValueComparison{row.text(9),    row.number(10), row.number(11), {row.number(12), row.number(13)},
                      row.number(14), row.number(15)};
  return value;
}

/// The row of the run with this file, and whether it has a comparison.
struct KnownRun {
  std::int64_t id{0};
  bool compared{false};
};

std::optional<KnownRun> find_run(const Connection& connection, const std::string& file_sha256) {
  Statement find = connection.prepare("SELECT id, verdict FROM run WHERE file_sha256 = ?");
  find.bind(0, file_sha256);
  if (!find.step()) return std::nullopt;
  return KnownRun{find.whole(0), !find.is_null(1)};
}

void remove_run(const Connection& connection, std::int64_t id) {
  for (const char* const sql : {"DELETE FROM value WHERE run = ?", "DELETE FROM run WHERE id = ?"}) {
    Statement remove = connection.prepare(sql);
    remove.bind(0, id).step();
  }
}

}  // namespace

Addition add_run(const std::filesystem::path& database, const RunRecord& run) {
  const Connection connection(database, Connection::Mode::create, wait_seconds);
  sqlite::Transaction transaction(connection);
  Addition addition = Addition::added;
  if (is_new(connection)) {
    make_tables(connection);
  } else {
    require_undamaged(connection);
    if (const std::optional<KnownRun> known = find_run(connection, run.file_sha256)) {
      if (known->compared || !run.comparison) return Addition::already_there;
      remove_run(connection, known->id);
      addition = Addition::comparison_added;
    }
  }
  insert_values(connection, insert_run(connection, run), run);
  transaction.commit();
  return addition;
}

std::vector<RunRecord> read_runs(const std::filesystem::path& database) {
  std::error_code error;
  if (!std::filesystem::exists(database, error)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: there is no such history; 'zerocount history add' makes it", database.string()));
  }
  const Connection connection(database, Connection::Mode::existing, wait_seconds);
  connection.execute("BEGIN");  // all that follows sees one state
  if (is_new(connection)) fail_foreign(connection);
  require_undamaged(connection);
  std::vector<RunRecord> runs;
  std::map<std::int64_t, std::size_t> places;  // [id]
  Statement rows = connection.prepare(
      "SELECT id, study, series_sha256, study_sha256, file_sha256, seed, trials, zerocount_version, "
      "git_commit, "
      "created, verdict, layer, baseline_created, baseline_commit FROM run ORDER BY created, id");
  while (rows.step()) {
    places[rows.whole(0)] = runs.size();
    runs.push_back(run_of(rows));
  }
  Statement values = connection.prepare(
      "SELECT run, point, measure, unit, kind, value, low, high, n, verdict, baseline, effect, effect_low, "
      "effect_high, margin, p FROM value ORDER BY rowid");
  while (values.step()) {
    const auto place = places.find(values.whole(0));
    if (place == places.end()) connection.fail_damaged();
    runs[place->second].values.push_back(value_of(values));
  }
  return runs;
}

}  // namespace zerocount::history

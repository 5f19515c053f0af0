#include "analysis/pairs/history/database.hpp"

#include <cerrno>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::history {
namespace {

/// The value of errno after an attempt to open the file for writing; 0 if it can be opened.
int opening_error(const std::filesystem::path& path) {
  const storage::FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  return file.valid() ? 0 : errno;
}

/// Throws the Failure that describes a failed call of SQLite for the database at `path`.
/// @param code error code of SQLite
/// @param system_error errno of the call that failed, or 0
[[noreturn]] void fail(const std::filesystem::path& path, int code, int system_error) {
  const auto failure = [&](ExitCode exit_code, const char* reason) {
    return Failure(exit_code, fmt::format("{}: {}", path.string(), reason));
  };
  switch (code & 0xff) {  // without the extension of the code
    case SQLITE_NOTADB:
      throw failure(ExitCode::bad_data,
                    "not a history of zerocount, or its beginning is damaged; expected an SQLite database");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw failure(
          ExitCode::machine_failed,
          "another process is writing it, and has not finished in time; try again when it has ended");
    case SQLITE_READONLY:
      throw failure(ExitCode::machine_failed, "cannot be written: it or its folder is read-only");
    case SQLITE_FULL:
      throw failure(ExitCode::machine_failed, "cannot be written: the disk is full");
    case SQLITE_NOMEM:
      throw failure(ExitCode::machine_failed, "out of memory");
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
    case SQLITE_PERM:
      if (system_error != 0) storage::fail_with(path, "open, read or write", system_error);
      throw failure(ExitCode::machine_failed, "cannot be opened, read or written");
    default:  // our statements are right, so the tables are not those of a history
      throw failure(
          ExitCode::bad_data,
          "damaged; expected a history as 'zerocount history add' writes it. Use a copy of it, or make a "
          "new one from the results files");
  }
}

/// A wait until another process releases the database. It begins with the first call of sleep().
class Patience {
 public:
  explicit Patience(const Wait& wait) : wait_(wait) {}

  /// Sleeps for 20 ms. False, without sleeping, if the longest time to wait is over.
  bool sleep() {
    using Clock = std::chrono::steady_clock;
    if (!start_) start_ = Clock::now();
    const double waited = std::chrono::duration<double>(Clock::now() - *start_).count();
    if (waited >= wait_.seconds) return false;
    if (waited >= wait_.notice && !std::exchange(noticed_, true) && wait_.notify) wait_.notify();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return true;
  }

 private:
  const Wait& wait_;
  std::optional<std::chrono::steady_clock::time_point> start_;
  bool noticed_{false};
};

/// Callback for sqlite3_busy_handler: waits while another process uses the database.
/// @param patience a Patience
/// @return 1: try again; 0: give up
int wait_for_other(void* patience, int /*calls*/) {
  return static_cast<Patience*>(patience)->sleep() ? 1 : 0;
}

using SQLite::Database;
using SQLite::Statement;

/// SQLite application_id of a history file ("zchi"), which distinguishes it from other SQLite files.
constexpr std::int64_t application_id = 0x7a636869;

/// SQL that creates the tables of a history. The program writes and reads the values of a row in the order of
/// these columns.
constexpr const char* schema_sql = R"(
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

std::string to_string(statistics::MeasurementKind kind) {
  return kind == statistics::MeasurementKind::proportion ? "proportion" : "mean";
}

[[noreturn]] void fail_foreign(const Database& database) {
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: an SQLite database, but not a history of zerocount; name "
                            "another file",
                            database.getFilename()));
}

/// The integer in the first column of the single row that the query `sql` returns.
std::int64_t number_of(Database& database, const char* sql) {
  return database.execAndGet(sql).getInt64();
}

/// True if the database is new and empty.
/// @throws Failure (bad_data) unless it is a history that this program can read.
bool is_new(Database& database) {
  const std::int64_t application = number_of(database, "PRAGMA application_id");
  const std::int64_t version = number_of(database, "PRAGMA user_version");
  const bool empty = number_of(database, "SELECT count(*) FROM sqlite_schema") == 0;
  if (empty && application == 0 && version == 0) return true;
  if (application != application_id) fail_foreign(database);
  if (version > schema_version) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: a history of version {}, and this program knows up to {}; use a newer "
                              "zerocount",
                              database.getFilename(), version, schema_version));
  }
  require_undamaged(version == schema_version);
  return false;
}

void check_pages(Database& database) {
  require_undamaged(database.execAndGet("PRAGMA quick_check(1)").getString() == "ok");
}

void make_tables(Database& database) {
  database.exec(schema_sql);
  database.exec(fmt::format("PRAGMA application_id = {}", application_id));
  database.exec(fmt::format("PRAGMA user_version = {}", schema_version));
}

std::int64_t insert_run(Database& database, const RunRecord& run) {
  Statement insert(database, "INSERT INTO run VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SQLite::bind(insert, run.study, run.series_sha256, run.study_sha256, run.file_sha256, run.seed, run.trials,
               run.zerocount_version, run.git_commit, run.created);
  if (const auto& compared = run.comparison) {
    insert.bind(10, compared->verdict);
    insert.bind(11, compared->layer);
    insert.bind(12, compared->baseline_created);
    insert.bind(13, compared->baseline_commit);
  }
  insert.exec();
  return database.getLastInsertRowid();
}

/// Inserts the values of the run with this row id into the database. NaN becomes NULL, because SQLite stores
/// NaN as NULL.
void insert_values(Database& database, std::int64_t id, const RunRecord& run) {
  Statement insert(database, "INSERT INTO value VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const RunValue& value : run.values) {
    const ValueComparison compared = value.comparison.value_or(ValueComparison{});
    SQLite::bind(insert, id, value.point, value.measure, value.unit, to_string(value.kind), value.value,
                 value.bounds.low, value.bounds.high, value.n, compared.verdict, compared.baseline,
                 compared.effect, compared.bounds.low, compared.bounds.high, compared.margin, compared.p);
    if (!value.comparison) insert.bind(10);  // NULL
    insert.exec();
    insert.reset();
  }
}

std::string text(Statement& row, int column) {
  require_undamaged(row.getColumn(column).isText());
  return row.getColumn(column).getString();
}

std::int64_t integer(Statement& row, int column) {
  require_undamaged(row.getColumn(column).isInteger());
  return row.getColumn(column).getInt64();
}

/// The number in this column of a row; NaN if the column is NULL.
double number(Statement& row, int column) {
  const SQLite::Column value = row.getColumn(column);
  if (value.isNull()) return statistics::unknown;
  require_undamaged(value.isFloat() || value.isInteger());
  return value.getDouble();
}

RunRecord run_of(Statement& row) {
  RunRecord run{{text(row, 1), text(row, 2), text(row, 3), text(row, 4), text(row, 5), integer(row, 6),
                 text(row, 7), text(row, 8), text(row, 9)}};
  if (!row.isColumnNull(10))
    run.comparison = RunComparison{text(row, 10), text(row, 11), text(row, 12), text(row, 13)};
  return run;
}

RunValue value_of(Statement& row) {
  RunValue value{text(row, 1), text(row, 2), text(row, 3)};
  if (text(row, 4) == to_string(statistics::MeasurementKind::proportion))
    value.kind = statistics::MeasurementKind::proportion;
  value.value = number(row, 5);
  value.bounds = {number(row, 6), number(row, 7)};
  value.n = integer(row, 8);
  if (row.isColumnNull(9)) return value;
  value.comparison =
      ValueComparison{text(row, 9),    number(row, 10), number(row, 11), {number(row, 12), number(row, 13)},
                      number(row, 14), number(row, 15)};
  return value;
}

/// A run that the database already contains: its row id, and whether it has a comparison with a baseline.
struct KnownRun {
  std::int64_t id{0};
  bool compared{false};
};

std::optional<KnownRun> find_run(Database& database, const std::string& file_sha256) {
  Statement find(database, "SELECT id, verdict FROM run WHERE file_sha256 = ?");
  find.bind(1, file_sha256);
  if (!find.executeStep()) return std::nullopt;
  return KnownRun{integer(find, 0), !find.isColumnNull(1)};
}

void remove_run(Database& database, std::int64_t id) {
  for (const char* const sql : {"DELETE FROM value WHERE run = ?", "DELETE FROM run WHERE id = ?"}) {
    Statement remove(database, sql);
    remove.bind(1, id);
    remove.exec();
  }
}

Addition add_to(Database& database, const RunRecord& run) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  Addition addition = Addition::added;
  if (is_new(database)) {
    make_tables(database);
  } else {
    check_pages(database);
    if (const std::optional<KnownRun> known = find_run(database, run.file_sha256)) {
      if (known->compared || !run.comparison) return Addition::already_there;
      remove_run(database, known->id);
      addition = Addition::comparison_added;
    }
  }
  insert_values(database, insert_run(database, run), run);
  transaction.commit();
  return addition;
}

std::vector<RunRecord> runs_of(Database& database) {
  const SQLite::Transaction transaction(database);  // all that follows reads one state
  if (is_new(database)) fail_foreign(database);
  check_pages(database);
  std::vector<RunRecord> runs;
  std::map<std::int64_t, std::size_t> places;  // [id]
  Statement rows(database, "SELECT * FROM run ORDER BY created, id");
  while (rows.executeStep()) {
    places[integer(rows, 0)] = runs.size();
    runs.push_back(run_of(rows));
  }
  Statement values(database, "SELECT * FROM value ORDER BY rowid");
  while (values.executeStep()) {
    const auto place = places.find(integer(values, 0));
    require_undamaged(place != places.end());
    runs[place->second].values.push_back(value_of(values));
  }
  return runs;
}

}  // namespace

void with_database(const std::filesystem::path& path, int flags, const Wait& wait,
                   const std::function<void(SQLite::Database&)>& action) {
  Patience patience(wait);
  std::optional<SQLite::Database> database;
  try {
    database.emplace(path.string(), SQLite::OPEN_READWRITE | flags);
    sqlite3_busy_handler(database->getHandle(), wait_for_other, &patience);
    action(*database);
  } catch (const SQLite::Exception& error) {
    fail(path, error.getErrorCode(),
         database ? sqlite3_system_errno(database->getHandle()) : opening_error(path));
  }
}

void require_undamaged(bool condition) {
  if (!condition) throw SQLite::Exception("damaged", SQLITE_CORRUPT);
}

Addition add_run(const std::filesystem::path& path, const RunRecord& run, const Wait& wait) {
  Addition addition{};
  with_database(path, SQLite::OPEN_CREATE, wait,
                [&](Database& database) { addition = add_to(database, run); });
  return addition;
}

bool has_run(const std::filesystem::path& path, const std::string& file_sha256, const Wait& wait) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  bool found = false;
  with_database(path, 0, wait, [&](Database& database) {
    if (is_new(database)) return;
    check_pages(database);
    found = find_run(database, file_sha256).has_value();
  });
  return found;
}

std::vector<RunRecord> read_runs(const std::filesystem::path& path, const Wait& wait) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: no such history; 'zerocount history add' makes it", path.string()));
  }
  std::vector<RunRecord> runs;
  with_database(path, 0, wait, [&](Database& database) { runs = runs_of(database); });
  return runs;
}

}  // namespace zerocount::history

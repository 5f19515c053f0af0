#include "analysis/history/sqlite.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::history {
namespace sqlite {

Statement::Statement(const Connection& connection, sqlite3_stmt* statement)
    : connection_(&connection), statement_(statement, [](sqlite3_stmt* one) { sqlite3_finalize(one); }) {}

void Statement::require(int code) const {
  if (code != SQLITE_OK) connection_->fail(code);
}

Statement& Statement::bind(int parameter, std::string_view text) {
  require(sqlite3_bind_text(statement_.get(), parameter + 1, text.data(), static_cast<int>(text.size()),
                            SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(int parameter, std::int64_t number) {
  require(sqlite3_bind_int64(statement_.get(), parameter + 1, number));
  return *this;
}

Statement& Statement::bind(int parameter, double number) {
  if (std::isnan(number)) return bind_null(parameter);
  require(sqlite3_bind_double(statement_.get(), parameter + 1, number));
  return *this;
}

Statement& Statement::bind_null(int parameter) {
  require(sqlite3_bind_null(statement_.get(), parameter + 1));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) connection_->fail(code);
  return false;
}

void Statement::reset() {
  require(sqlite3_reset(statement_.get()));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::string Statement::text(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_TEXT) connection_->fail_damaged();
  const unsigned char* const bytes = sqlite3_column_text(statement_.get(), column);
  if (bytes == nullptr) connection_->fail(SQLITE_NOMEM);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return {bytes, bytes + size};
}

std::int64_t Statement::whole(int column) const {
  if (sqlite3_column_type(statement_.get(), column) != SQLITE_INTEGER) connection_->fail_damaged();
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) connection_->fail_damaged();
  return sqlite3_column_double(statement_.get(), column);
}

Connection::Connection(std::filesystem::path path, Mode mode, double wait)
    : path_(std::move(path)), connection_(nullptr, sqlite3_close) {
  sqlite3* opened = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0);
  const int code = sqlite3_open_v2(path_.c_str(), &opened, flags, nullptr);
  connection_.reset(opened);
  require(code);
  require(sqlite3_busy_timeout(opened, static_cast<int>(1000.0 * wait)));
}

void Connection::execute(const std::string& sql) const {
  require(sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

Statement Connection::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  require(
      sqlite3_prepare_v2(connection_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
  return {*this, statement};
}

std::int64_t Connection::last_row() const {
  return sqlite3_last_insert_rowid(connection_.get());
}

std::int64_t Connection::whole_number(std::string_view sql) const {
  Statement statement = prepare(sql);
  if (!statement.step()) fail_damaged();
  return statement.whole(0);
}

void Connection::require(int code) const {
  if (code != SQLITE_OK) fail(code);
}

void Connection::fail_damaged() const {
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: is damaged; expected a history as 'zerocount history add' writes it. Use a "
                            "copy of it, or make a new one from the results files",
                            path_.string()));
}

void Connection::fail(int code) const {
  const int error = connection_ ? sqlite3_system_errno(connection_.get()) : 0;
  switch (code & 0xff) {
    case SQLITE_NOTADB:
      throw Failure(ExitCode::bad_data, fmt::format("{}: is no history of zerocount, or its beginning is "
                                                    "damaged; expected an SQLite database",
                                                    path_.string()));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw Failure(ExitCode::machine_failed,
                    fmt::format("{}: another process is writing it, and has not finished in time; try again "
                                "when it has ended",
                                path_.string()));
    case SQLITE_READONLY:
      throw Failure(ExitCode::machine_failed,
                    fmt::format("{}: cannot be written: it or its folder is read-only", path_.string()));
    case SQLITE_FULL:
      throw Failure(ExitCode::machine_failed,
                    fmt::format("{}: cannot be written: the disk is full", path_.string()));
    case SQLITE_NOMEM:
      throw Failure(ExitCode::machine_failed, fmt::format("{}: out of memory", path_.string()));
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
    case SQLITE_PERM:
      if (error != 0) storage::fail_with(path_, "open, read or write", error);
      throw Failure(ExitCode::machine_failed,
                    fmt::format("{}: cannot be opened, read or written", path_.string()));
    default:  // with statements that are right, the tables are not those of a history
      fail_damaged();
  }
}

Transaction::Transaction(const Connection& connection) : connection_(connection) {
  connection_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    connection_.execute("ROLLBACK");
  } catch (const Failure&) {  // SQLite undoes it when the file is opened next
  }
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace sqlite
}  // namespace zerocount::history

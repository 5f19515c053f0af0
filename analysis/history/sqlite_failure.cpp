#include "analysis/history/sqlite_failure.hpp"

#include <cerrno>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include "core/failure/failure.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_descriptor.hpp"

namespace zerocount::history {
namespace {

/// errno of opening the file for writing; 0 if it can be opened.
int opening_error(const std::filesystem::path& path) {
  const storage::FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  return file.valid() ? 0 : errno;
}

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

/// A wait in progress.
class Patience {
 public:
  explicit Patience(const Wait& wait) : wait_(wait) {}

  /// Sleeps for a moment; false where the time is over.
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

/// @return as sqlite3_busy_handler expects: 0 to give up
int wait_for_other(void* patience, int /*calls*/) {
  return static_cast<Patience*>(patience)->sleep() ? 1 : 0;
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

}  // namespace zerocount::history

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/pairs/history/run_record.hpp"

namespace SQLite {
class Database;
}

/// The SQLite file that keeps a history: the values of many runs of studies over time. README.md documents
/// its schema.
namespace zerocount::history {

/// The version of the tables in a history file, kept as the SQLite `user_version` of the file.
inline constexpr std::int64_t schema_version = 1;

/// Limits for the wait until another process releases a database file.
struct Wait {
  double seconds{60.0};  ///< Longest time to wait, s; after it the call fails.
  double notice{1.0};    ///< Waiting time after which `notify` is called once, s.
  /// Function that is called once when the wait exceeds `notice`, to tell the user; may be empty.
  std::function<void()> notify{};
};

/// The change that add_run() made to the history.
enum class Addition {
  added,
  already_there,  ///< The history already contained the run; nothing changed.
  /// The history already contained the run, but without its comparison with a baseline, which was added now.
  comparison_added,
};

/// Adds a run of a study to a history file; creates the file if it does not exist. Either the whole run is
/// added or nothing. Waits while another process writes.
/// @throws Failure: bad_data if the file is damaged, is not a history, or has a newer version of the schema;
/// machine_failed if it cannot be written.
Addition add_run(const std::filesystem::path& database, const RunRecord& run, const Wait& wait = {});

/// Whether the history contains the run of a results file with this checksum. False if there is no history
/// file.
/// @throws Failure as add_run()
bool has_run(const std::filesystem::path& database, const std::string& file_sha256, const Wait& wait = {});

/// All runs of a history, sorted by the time at which they were made.
/// @throws Failure: bad_input if there is no such file, otherwise as add_run().
std::vector<RunRecord> read_runs(const std::filesystem::path& database, const Wait& wait = {});

/// Opens an SQLite database for reading and writing, and applies `action` to it.
/// @param flags SQLite::OPEN_CREATE, or 0: the file must exist
/// @throws Failure for every SQLite::Exception, with the file's name and the reason in our words: bad_data
/// for damage or another format, otherwise machine_failed
void with_database(const std::filesystem::path& path, int flags, const Wait& wait,
                   const std::function<void(SQLite::Database&)>& action);

/// Reports a damaged history: throws an SQLite::Exception, which with_database() reports as damage, unless
/// `condition` holds.
void require_undamaged(bool condition);

}  // namespace zerocount::history

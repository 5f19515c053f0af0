#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/history/run_record.hpp"

namespace SQLite {
class Database;
}

/// The SQLite file of a history. README.md documents its schema.
namespace zerocount::history {

/// The version of the schema, kept as the file's `user_version`.
inline constexpr std::int64_t schema_version = 1;

/// Limits for waiting until another process releases a database.
struct Wait {
  double seconds{60.0};            ///< Longest time to wait, s.
  double notice{1.0};              ///< Time after which `notify` is called once, s.
  std::function<void()> notify{};  ///< Called once after `notice`; may be empty.
};

/// Result of add_run().
enum class Addition {
  added,
  already_there,  ///< The run had been added before; nothing changed.
  /// The run had been added before without its comparison, which was added now.
  comparison_added,
};

/// Adds a run to a history; creates the file if it does not exist. Either the whole run is added or nothing.
/// Waits while another process writes.
/// @throws Failure: bad_data if the file is damaged, is something else, or has a newer version of the schema;
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

/// Throws an SQLite::Exception that with_database() reports as damage, unless `condition` holds.
void require_undamaged(bool condition);

}  // namespace zerocount::history

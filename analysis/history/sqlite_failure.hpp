#pragma once

#include <filesystem>
#include <functional>

#include <SQLiteCpp/SQLiteCpp.h>

#include "analysis/history/database.hpp"

namespace zerocount::history {

/// Opens an SQLite database for reading and writing, and applies `action` to it.
/// @param flags SQLite::OPEN_CREATE, or 0: the file must exist
/// @throws Failure for every SQLite::Exception, with the file's name and the reason in our words: bad_data
/// for damage or another format, otherwise machine_failed
void with_database(const std::filesystem::path& path, int flags, const Wait& wait,
                   const std::function<void(SQLite::Database&)>& action);

/// Throws an SQLite::Exception that with_database calls damage, unless `condition` holds.
void require_undamaged(bool condition);

}  // namespace zerocount::history

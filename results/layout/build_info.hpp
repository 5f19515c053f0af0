#pragma once

#include <string>

namespace zerocount::layout {

/// Who made a results file, and when.
struct Provenance {
  std::string zerocount_version;
  std::string git_commit;  ///< "unknown" where the sources were no git checkout
  std::string compiler;
  std::string cpu;
  std::string created;  ///< UTC, as 2002-07-21T12:00:00Z
};

/// This program on this machine, now.
Provenance current_provenance();

/// Whether two programs are the same for the trials they run: of one version and one commit. Changes that
/// were not committed ("-dirty") cannot be told apart, and do not count.
bool same_build(const Provenance& one, const Provenance& other);

/// Whether the sources had changes that were not committed.
bool is_dirty(const Provenance& provenance);

}  // namespace zerocount::layout

#pragma once

#include <string>

namespace zerocount {

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

}  // namespace zerocount

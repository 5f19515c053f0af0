#pragma once

namespace zerocount::storage {

/// When a file that is closed is brought to the disk.
enum class Flush {
  now,
  later  ///< by the caller: synchronise(), or now when it is closed again
};

}  // namespace zerocount::storage

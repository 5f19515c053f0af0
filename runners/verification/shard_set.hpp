#pragma once

#include <filesystem>
#include <span>

#include "results/layout/header.hpp"
#include "runners/verification/check.hpp"

namespace zerocount::verification {

/// A shard whose header was read.
struct ShardHeader {
  std::filesystem::path path;
  layout::FileHeader header;
};

/// Checks that the shards of a folder are of one study, build and engine, and that they hold each of its
/// trials once. The study is that of most shards.
/// @param stops the study has a stopping rule: it may hold fewer trials than its manifest allows
void check_shard_set(CheckReport& report, std::span<const ShardHeader> shards, bool stops);

}  // namespace zerocount::verification

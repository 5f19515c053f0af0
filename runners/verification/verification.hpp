#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "core/plugin/controller_plugin.hpp"
#include "runners/verification/check.hpp"

/// Checks whether results files are whole, and hold what their manifests say.
namespace zerocount::verification {

struct VerifySettings {
  std::int64_t trials{20};  ///< to run again: of each file, or of all shards of a folder together
  std::uint64_t seed{1};    ///< of their choice
  std::shared_ptr<const plugin::ControllerPlugin> plugin{};  ///< the user's controller; null: none is given
  std::stop_token stop{};
};

/// Verifies results files, parts, shards, and folders of these. Goes on after a failure, but a read that
/// fails after the checksum was right ends the process (hdf5/file_driver.hpp).
/// @returns one report per file, in the order of the operands, and one per folder of shards after its files
/// @throws Failure: interrupted if a stop was requested; bad_input if an operand does not exist, a folder has
/// no results files, or the controller of a study is a plugin that is not given
std::vector<CheckReport> verify(std::span<const std::filesystem::path> operands,
                                const VerifySettings& settings);

}  // namespace zerocount::verification

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "results/layout/header.hpp"
#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {

/// The contents of a file of `zerocount rare`: the header, the question, and the state of the estimate.
struct RareRecord {
  layout::FileHeader header;
  Population of;
  std::string event;  ///< MoveEvent::text
  EstimatorState state;
  double seconds{0.0};  ///< that the estimate took so far
};

/// Writes the answer's file: the header and the manifest, /estimate (JSON: what was learned and the answer),
/// and /drawn, a row for each trial drawn from the proposal with its weight, inputs and coordinates.
/// @throws Failure (machine_failed)
void write_rare_file(const RareAnswer& answer);

/// @throws Failure: bad_data for a damaged file, ForeignFile for another format
RareRecord read_rare_file(const std::filesystem::path& path);

/// Whether a file was written by write_rare_file(). @throws Failure as read_rare_file
bool is_rare_file(const std::filesystem::path& path);

/// The question that the file answers.
/// @param plugin the user's controller; null: as recorded
/// @throws Failure as layout::recorded_study
Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin = nullptr);

}  // namespace zerocount::rare

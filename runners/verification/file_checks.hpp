#pragma once

#include <memory>
#include <optional>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::verification {

/// Checks that the bytes are those that were written: the checksum trailer.
/// @return the check holds, and the file may be opened
bool check_checksum(CheckReport& report);

/// A header, and the study that it describes.
struct Described {
  layout::FileHeader header;
  study::Study study;
};

/// Checks everything that can be told without running a trial: the file was finished, and its attributes are
/// those of its manifest; inputs, measures, jerks and sums are possible; and the file, made again from its
/// manifest and its trials as a merge makes it, has the same datasets with the same values and units. Design
/// points, profiles, machines, numbers of rows and statistics follow from the trials and the manifest.
///
/// Needs as much room in the folder for temporary files as the file takes.
/// @param plugin as recorded_study
/// @return nothing if its trials cannot be read, so that none can be run again
std::optional<Described> check_statistics(CheckReport& report,
                                          const std::shared_ptr<const plugin::ControllerPlugin>& plugin);

}  // namespace zerocount::verification

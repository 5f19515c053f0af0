#pragma once

#include <memory>
#include <optional>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::verification {

/// Checks by the checksum at the end of the file that its bytes are the ones that were written. Adds the
/// check to the report.
/// @return whether the check holds, so that the file may be opened
bool check_checksum(CheckReport& report);

/// Header of a results file, and the study that the header's manifest describes.
struct Described {
  layout::FileHeader header;
  study::Study study;
};

/// Checks everything in a results file that can be checked without simulating a trial, and adds the checks to
/// the report.
///
/// The file must be finished, and its attributes must follow from its manifest. Inputs, measures, jerks and
/// sums must be possible. The file is made again from its manifest and its trials, as a merge makes it, and
/// must have the same datasets with the same values and units. Design points, profiles, machines, numbers of
/// rows and statistics follow from the trials and the manifest.
///
/// The folder for temporary files needs as much room as the file takes.
/// @param plugin the user's controller, as for recorded_study; null: none is given
/// @return header and study; nothing if the trials cannot be read, so that none can be run again
std::optional<Described> check_statistics(CheckReport& report,
                                          const std::shared_ptr<const plugin::ControllerPlugin>& plugin);

}  // namespace zerocount::verification

#pragma once

#include <memory>
#include <optional>

#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::verification {

/// Checks by the checksum trailer that the bytes are the ones that were written.
/// @return whether the check holds, so that the file may be opened
bool check_checksum(CheckReport& report);

/// Header of a results file, and the study that it describes.
struct Described {
  layout::FileHeader header;
  study::Study study;
};

/// Checks everything that can be checked without running a trial.
///
/// The file must be finished, and its attributes must follow from its manifest. Inputs, measures, jerks and
/// sums must be possible. The file is made again from its manifest and its trials, as a merge makes it, and
/// must have the same datasets with the same values and units. Design points, profiles, machines, numbers of
/// rows and statistics follow from the trials and the manifest.
///
/// The folder for temporary files needs as much room as the file takes.
/// @param plugin as for recorded_study
/// @return header and study; nothing if the trials cannot be read, so that none can be run again
std::optional<Described> check_statistics(CheckReport& report,
                                          const std::shared_ptr<const plugin::ControllerPlugin>& plugin);

}  // namespace zerocount::verification

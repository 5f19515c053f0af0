#pragma once

#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"
#include "runners/verification/check.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {

/// Makes the file again from its manifest and its trials, as a merge does, and compares all datasets: design
/// points, profiles, rigs and statistics follow from the trials and the manifest.
///
/// Needs as much room in the folder for temporary files as the file takes. Files of an earlier version of the
/// layout, and shards, which have nothing that follows, are skipped.
void check_rebuilt(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                   Equality equality);

}  // namespace zerocount::verification

#pragma once

#include <filesystem>
#include <optional>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "runners/verification/check.hpp"

namespace zerocount::verification {

/// Checks that the bytes are those that were written: the checksum trailer.
/// @return the check holds, and the file may be opened
bool check_bytes(CheckReport& report);
/// Opens a file whose checksum need not hold.
/// @param[out] holds whether it does
bool check_bytes_to_reseal(CheckReport& report, bool& holds);

/// A header, and the study that it describes.
struct Described {
  layout::FileHeader header;
  study::Study study;
};

/// Checks that the file was finished, and that its attributes are those of the study of its manifest.
/// @param plugin as recorded_study
/// @return nothing if the study cannot be made
std::optional<Described> check_header(CheckReport& report,
                                      const std::shared_ptr<const plugin::ControllerPlugin>& plugin);

/// Checks that all datasets of trials and sums are there, with their types, sizes and units, and that all
/// rows have their numbers.
/// @return the opened file, unless it cannot be read
std::optional<reading::ResultsFile> check_tables(CheckReport& report, const study::Study& study);

}  // namespace zerocount::verification

#pragma once

#include <filesystem>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"

namespace zerocount::study_run {

/// Treatment of an existing output file.
enum class ExistingUse {
  none,      ///< there is no file, or it is replaced
  complete,  ///< the file has all wanted trials
  extend     ///< the file is complete, and the study differs only in having more trials
};

/// @param wanted rows of the run
/// @throws Failure (bad_input) for any other file, with the differences.
ExistingUse use_of_existing(const std::filesystem::path& output, const study::Study& study,
                            layout::RowRange wanted);

}  // namespace zerocount::study_run

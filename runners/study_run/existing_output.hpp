#pragma once

#include <filesystem>

#include "experiments/study/study.hpp"
#include "results/layout/row_range.hpp"

namespace zerocount {

/// What a run makes of a results file that has its output's name already.
enum class ExistingUse {
  none,      ///< there is none, or it is replaced
  complete,  ///< it holds the trials that are wanted
  extend     ///< it is complete, and the study is the same but for more trials
};

/// @param wanted the rows that the run is for
/// @throws Failure (bad_input) where the file is anything else, with what differs.
ExistingUse use_of_existing(const std::filesystem::path& output, const Study& study, RowRange wanted);

}  // namespace zerocount

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount::tuning {

/// The study with these values ("key=value") written into the text of its manifest, where its comments stay.
/// Overrides of the study become part of the text too. A value that the text cannot take, such as a list,
/// stays an override.
/// @throws Failure (bad_input) as parse_study
study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values);

}  // namespace zerocount::tuning

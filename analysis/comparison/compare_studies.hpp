#pragma once

#include <filesystem>
#include <optional>

#include "analysis/comparison/comparison.hpp"
#include "analysis/comparison/gate_rules.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::comparison {

/// Compares a results file with a baseline: finds what the two have in common, matches their design points,
/// tests every measure at every point, controls the false discoveries over all of them, and gives verdicts.
/// @throws Failure (bad_data) where points cannot be matched, one file has targets and the other torque
/// levels, or a file is damaged.
StudyComparison compare_studies(const reading::StudyFile& baseline, const reading::StudyFile& current,
                                const GateRules& rules = {});

/// The same of two files, with the rules of the file `margins`, where one is given.
/// @throws Failure as compare_studies and read_gate_rules, and as StudyFile
StudyComparison compare_files(const std::filesystem::path& baseline, const std::filesystem::path& current,
                              const std::optional<std::filesystem::path>& margins = std::nullopt);

}  // namespace zerocount::comparison

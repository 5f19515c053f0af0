#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/comparison/manifest_differences.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::comparison {

/// A design point that both files have.
struct MatchedPoint {
  std::string label;
  std::int64_t baseline{0};
  std::int64_t current{0};
};

/// The design points of both files, by label, in the order of the baseline. Where the label is the name of a
/// case, or holds one, the axes may differ: the case may have been given another gain. Otherwise the axes
/// must agree to the bit.
/// @throws Failure (bad_data) that names what has no partner.
std::vector<MatchedPoint> match_points(const reading::StudyFile& baseline, const reading::StudyFile& current);

/// Whether trial i of both files drew the same random numbers.
struct DrawComparison {
  bool same{false};
  std::string reason;                       ///< one line
  std::vector<std::string> changed_inputs;  ///< whose values differ all the same, because the manifests do
};

/// The seeds and designs must be the same, and every drawn parameter of both files must have the same value
/// in trial i, to the bit, or, where its distribution was changed, rise in the same order of trials: equal
/// draws through another distribution. Looked at in all trials that both have.
DrawComparison compare_draws(const reading::StudyFile& baseline, const reading::StudyFile& current,
                             const ManifestValues& old_values, const ManifestValues& new_values,
                             const std::vector<MatchedPoint>& points);

}  // namespace zerocount::comparison

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/manifest_text/manifest_values.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::comparison {

/// A design point that both files have.
struct MatchedPoint {
  std::string label;
  std::int64_t baseline{0};
  std::int64_t current{0};
};

/// Matches the design points of both files by label, in the order of the baseline. In studies with cases the
/// axes may differ, because a case may have got another gain; otherwise they must be bitwise equal.
/// @throws Failure (bad_data) that lists the points without a partner.
std::vector<MatchedPoint> match_points(const reading::AllTrialsFile& baseline,
                                       const reading::AllTrialsFile& current);

/// The value of a swept key at a design point, as text; "missing" if it is not swept.
std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point);

/// Whether trial i of both files drew the same random numbers.
struct DrawComparison {
  bool same{false};
  std::string reason;                       ///< one line
  std::vector<std::string> changed_inputs;  ///< whose values differ all the same, because the manifests do
};

/// The draws are the same if the seeds and designs are equal and every random parameter of both files either
/// has bitwise equal values in the first `trials` trials of the points or, after a change of its
/// distribution, sorts them in the same order.
DrawComparison compare_draws(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                             const manifest_text::ManifestValues& old_values,
                             const manifest_text::ManifestValues& new_values,
                             const std::vector<MatchedPoint>& points, std::int64_t trials);

}  // namespace zerocount::comparison

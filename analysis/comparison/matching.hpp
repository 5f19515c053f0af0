#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/manifest_text/manifest_values.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::comparison {

/// A design point that both files have, under one condition where they have any.
struct MatchedPoint {
  std::string label;  ///< with the condition
  std::int64_t baseline{0};
  std::int64_t current{0};
  std::string design_point{};                          ///< its label without the condition
  std::string condition{};                             ///< empty without conditions
  const reading::AllTrialsFile* in_baseline{nullptr};  ///< the trials, of this condition only
  const reading::AllTrialsFile* in_current{nullptr};

  layout::RowRange baseline_rows(std::int64_t trials) const {  ///< its first trials
    return {baseline * in_baseline->header().trials, trials};
  }
  layout::RowRange current_rows(std::int64_t trials) const {
    return {current * in_current->header().trials, trials};
  }
};

/// The conditions of both files, matched by name, with the files as those of one study for each. Without
/// conditions there is one without a name, and the files are as they are. Points refer to it.
class MatchedConditions {
 public:
  /// @throws Failure (bad_data) that lists the conditions without a partner
  MatchedConditions(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current);

  std::int64_t count() const { return std::max<std::int64_t>(std::ssize(names_), 1); }
  const std::vector<std::string>& names() const { return names_; }
  /// Each point under each condition, by point.
  std::vector<MatchedPoint> points(const std::vector<MatchedPoint>& design_points) const;

 private:
  std::vector<std::string> names_{};                      ///< in the order of the baseline
  std::vector<reading::AllTrialsFile> baseline_under_{};  ///< [condition]
  std::vector<reading::AllTrialsFile> current_under_{};   ///< likewise; empty where both are one file
};

/// Matches the design points of both files by label, in the order of the baseline. In studies with cases the
/// axes may differ, because a case may have got another gain; otherwise they must be bitwise equal.
/// @throws Failure (bad_data) that lists the points without a partner.
/// They are not under conditions yet: MatchedConditions::points().
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

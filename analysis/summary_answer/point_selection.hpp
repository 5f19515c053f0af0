#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/summary/summary.hpp"

/// Which design points a table shows, and in which order.
namespace zerocount::summary_answer {

/// The points that a user asks for.
struct PointSelection {
  std::optional<std::string> sort{};  ///< name of a value, with a leading '-' from the largest on; or "best"
  std::vector<std::string> where{};   ///< conditions, such as "kp > 0" or "success_rate ≥ 0.9"
  std::optional<std::int64_t> top{};  ///< so many of them, by points_by_merit() unless sorted otherwise
};

/// The values that a selection needs: the names of swept parameters left out.
std::vector<std::string> columns_needed(const summary::StudySummary& summary,
                                        const PointSelection& selection);

/// Whether it names a bound of a mean by resampling ("settling_time.mean_low").
bool needs_mean_bounds(const PointSelection& selection);

/// @throws Failure (bad_input) where the summary has no value of a name that is needed
void require_columns(const summary::StudySummary& summary, const PointSelection& selection);

/// The selected points in their order. Values have the names of the columns of the CSV, where a '.' may
/// stand for '_' ("settling_time.p95"), and those of swept parameters, which may be shortened to an end that
/// no other has ("ki"). A value that is NaN comes last, and meets no condition. Names, such as those of cases
/// and labels, are equal (= or ==) or not (!=), and are sorted by the alphabet.
/// @throws Failure (bad_input) for an unknown name or a condition that is none, (inconclusive) if no point
/// is left
/// @param known [name of a column][point] values that the file stores, in place of those of the statistics
std::vector<std::int64_t> selected_points(const summary::StudySummary& summary,
                                          const PointSelection& selection,
                                          const std::map<std::string, std::vector<double>>& known = {});

}  // namespace zerocount::summary_answer

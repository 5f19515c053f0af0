#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/summary.hpp"
#include "analysis/text.hpp"

namespace zerocount {
namespace {

std::string interval_in_percent(const ConfidenceInterval& interval) {
  return fmt::format("[{:.1f}, {:.1f}]", 100.0 * interval.low, 100.0 * interval.high);
}

bool any_observed(const StudySummary& summary) {
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    if (!observed_at(summary, static_cast<std::int64_t>(i)).empty()) return true;
  }
  return false;
}

constexpr std::string_view legend =
    "stable: share of trials whose moves all arrived and stayed within one count\n"
    "zero-count: share of trials whose moves all ended at zero error; bounds of it after Clopper and "
    "Pearson, in %\n"
    "median, p95: settling time of the moves that arrived; arrived: their share of all moves\n"
    "jerks/trial: mean over all trials\n";

constexpr std::string_view prediction_legend =
    "(6), (7): share of trials in which the paper's criterion (6) holds, which promises stability before "
    "sliding, and\n"
    "in which its criterion (7) is exceeded, which rules it out; by the friction where the trial starts\n";

/// A line for every point with trials whose motion was lost: they count as failures, and the reader must
/// know.
std::string nonfinite_notes(const StudySummary& summary) {
  std::string notes;
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const std::int64_t lost = summary.points[i].outcomes.nonfinite;
    if (lost == 0) continue;
    notes += fmt::format(
        "{}: {} of {} trials nonfinite: the motion left the finite numbers or could not be followed\n",
        printable(summary.labels[i]), lost, summary.points[i].trials);
  }
  return notes;
}

}  // namespace

std::string summary_table(const StudySummary& summary) {
  require_consistent(summary);
  const bool with_observed = any_observed(summary);
  const bool with_predictions = !summary.predictions.empty();
  std::vector<std::string> header{"point",      "trials",  "stable",  "zero-count", "95 % bounds",
                                  "median (s)", "p95 (s)", "arrived", "jerks/trial"};
  std::vector<bool> numeric{false, true, true, true, true, true, true, true, true};
  if (with_predictions) {
    header.insert(header.end(), {"(6) holds", "(7) exceeded"});
    numeric.insert(numeric.end(), {true, true});
  }
  if (with_observed) {
    header.push_back("observed");
    numeric.push_back(false);
  }

  std::vector<std::vector<std::string>> cells{header};
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const PointSummary& point = summary.points[i];
    std::vector<std::string> row{printable(summary.labels[i]),
                                 fmt::format("{}", point.trials),
                                 percentage(point.stable, point.trials),
                                 percentage(point.outcomes.zero_count, point.trials),
                                 interval_in_percent(point.success_rate.clopper_pearson),
                                 short_number(point.settling_time.median.value),
                                 short_number(point.settling_time.p95.value),
                                 percentage(point.settling_time.n, point.moves),
                                 short_number(point.jerk_count.mean)};
    if (with_predictions) {
      const TheoryPrediction& prediction = summary.predictions[i];
      row.push_back(percentage(prediction.stable, prediction.trials));
      row.push_back(percentage(prediction.unstable, prediction.trials));
    }
    if (with_observed) row.push_back(printable(observed_at(summary, static_cast<std::int64_t>(i))));
    cells.push_back(std::move(row));
  }
  return printable(summary.name) + "\n\n" + aligned_table(cells, numeric) + nonfinite_notes(summary) + "\n" +
         std::string(legend) + std::string(with_predictions ? prediction_legend : "");
}

}  // namespace zerocount

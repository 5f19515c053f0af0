#include <fmt/format.h>

#include "analysis/statistics/confidence_sequence.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::summary {
namespace {

std::vector<statistics::ConfidenceInterval> bounds_of(std::span<const measures::PointSummary> points,
                                                      double confidence) {
  std::vector<statistics::ConfidenceInterval> bounds;
  bounds.reserve(points.size());
  for (const measures::PointSummary& point : points) {
    bounds.push_back(
        statistics::confidence_sequence_bounds(point.outcomes.zero_count, point.judged, confidence));
  }
  return bounds;
}

double halfwidth(const statistics::ConfidenceInterval& bounds) {
  return 0.5 * (bounds.high - bounds.low);
}

/// @param bounds at the confidence of the summary. @param judged at that of the rule.
void add_text(measures::SummarySection& section, const std::vector<statistics::ConfidenceInterval>& bounds,
              const std::vector<statistics::ConfidenceInterval>& judged,
              const std::vector<std::string>& labels, const study::StoppingRule& rule, std::int64_t rigs,
              double confidence) {
  text::PointTable table{
      {{"point", false, {}},
       {text::percent(confidence) + " bounds of zero-count, however often one looks (%)", false, {}},
       {fmt::format("asked for: ± {:.4g} %, came to", 100.0 * rule.success_rate_halfwidth), false, {}}},
      {}};
  bool reached = true;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const bool here = halfwidth(judged[i]) <= rule.success_rate_halfwidth;
    reached = reached && here;
    table.columns[0].cells.push_back(text::printable(labels[i]));
    table.columns[1].cells.push_back(
        fmt::format("[{}]", text::percent_bounds(bounds[i].low, bounds[i].high, 2)));
    table.columns[2].cells.push_back(fmt::format(
        "± {} %{}", text::rounded_up(100.0 * halfwidth(judged[i]), 2), here ? "" : ": not reached"));
    table.points.push_back(static_cast<std::int64_t>(i));
  }
  section.tables.push_back(std::move(table));
  section.note = fmt::format(
      "how many trials there are was decided by their outcomes, after every {} at each point{}; all other "
      "bounds are those of a number fixed beforehand\n{}",
      rule.block, reached ? "" : ", and ended by max_trials before all was known as well as asked for",
      rigs == 0 ? ""
                : fmt::format("these bounds are of the mean over the {} rigs of the study, which more trials "
                              "narrow; those over all rigs are in the table above, and more rigs narrow "
                              "them\n",
                              rigs));
}

}  // namespace

measures::SummarySection stopping_section(std::span<const measures::PointSummary> points,
                                          const std::vector<std::string>& labels,
                                          const study::StoppingRule& rule, double confidence) {
  const std::vector<statistics::ConfidenceInterval> bounds = bounds_of(points, confidence);
  const std::vector<statistics::ConfidenceInterval> judged = bounds_of(points, rule.confidence);
  const auto column = [](const std::string& side, const std::string& bound) {
    return layout::PointColumn{"stopped_success_rate_" + side,
                               "1",
                               bound + " bound of the success rate that holds however often one looks",
                               {}};
  };
  const std::int64_t rigs = points.empty() ? 0 : points.front().rigs.n;
  measures::SummarySection section{
      .key = "stopped", .json = {}, .columns = {column("low", "lower"), column("high", "upper")}};
  section.of_success = true;
  add_text(section, bounds, judged, labels, rule, rigs, confidence);
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    section.columns[0].values.push_back(bounds[i].low);
    section.columns[1].values.push_back(bounds[i].high);
    section.json.push_back({{"success_rate_low", bounds[i].low},
                            {"success_rate_high", bounds[i].high},
                            {"confidence", confidence},
                            {"halfwidth", halfwidth(judged[i])},
                            {"halfwidth_asked", rule.success_rate_halfwidth},
                            {"halfwidth_confidence", rule.confidence},
                            {"reached", halfwidth(judged[i]) <= rule.success_rate_halfwidth}});
    if (rigs > 0) section.json.back()["of_rigs"] = rigs;
  }
  return section;
}

}  // namespace zerocount::summary

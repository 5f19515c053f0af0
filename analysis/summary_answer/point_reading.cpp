#include "analysis/summary_answer/point_reading.hpp"

#include "analysis/summary/worlds_of_point.hpp"

namespace zerocount::summary_answer {

std::vector<LevelReading> SummaryReading::levels() const {
  std::vector<LevelReading> levels;
  for (const PointReading& point : points) {
    for (std::size_t level = 0; level < point.statistics().levels.size(); ++level)
      levels.push_back({point, level});
  }
  return levels;
}

PointReading read_point(const summary::StudySummary& summary, std::int64_t point) {
  PointReading reading{summary, point};
  const measures::PointSummary& statistics = reading.statistics();
  if (summary.question.claim() && statistics.trials > 0)
    reading.verdict = goal::verdict_on(summary.question, statistics);
  if (summary.question.worlds > 0) reading.worlds = summary::worlds_of_point(summary, point);
  if (const auto counts = summary.observed_counts.find(reading.label());
      counts != summary.observed_counts.end())
    reading.observed = summary::compare_observed(statistics, counts->second);
  return reading;
}

SummaryReading read_summary(const summary::StudySummary& summary, const SummaryForm& form) {
  summary::require_consistent(summary);
  SummaryReading reading{summary, summary::choose_point(summary, form.chosen), {}, form.legend};
  const std::vector<std::int64_t> points =
      form.points.empty() ? summary::complete_points(summary) : form.points;
  for (const std::int64_t point : points) {
    reading.points.push_back(read_point(summary, point));
    reading.points.back().marked = summary.points.size() > 1 && point == reading.chosen.point;
  }
  return reading;
}

}  // namespace zerocount::summary_answer

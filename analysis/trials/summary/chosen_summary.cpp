#include "analysis/trials/summary/chosen_summary.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::summary {
namespace {

/// Table of only those measures by which the design points of a study are compared: the settling times of the
/// goals.
std::shared_ptr<const layout::MeasureTable> compared_measures(const layout::MeasureTable& table,
                                                              const goal::Question& question) {
  auto compared = std::make_shared<layout::MeasureTable>();
  const std::vector<std::string> names = goal::settling_measures(question);
  for (const layout::Measure& measure : table) {
    if (std::ranges::find(names, measure.field.column.name) != names.end()) compared->push_back(measure);
  }
  return compared;
}

/// The statistics of a design point, reduced to the measures in `table`, by which points are compared.
measures::PointSummary only_compared(measures::PointSummary&& point, const layout::MeasureTable& table) {
  std::vector<measures::MeasureStatistics> compared;
  for (const layout::Measure& measure : table) compared.push_back(named(point, measure.field.column.name));
  point.table = &table;
  point.measures = std::move(compared);
  point.by_move = {};
  return std::move(point);
}

const layout::MeasureTable& table_of(const reading::AllTrialsFile& file) {
  return file.table();
}
const layout::MeasureTable& table_of(const reading::ResultsFile& file) {
  return layout::measure_table(file.study().features);
}

void add_trials(StudyAccumulator& accumulator, const reading::AllTrialsFile& file) {
  accumulator.add(file, file.rows());
}
void add_trials(StudyAccumulator& accumulator, const reading::ResultsFile& file) {
  accumulator.add(file);
}

template <class File>
ChosenSummary summarise_chosen(const File& file, std::optional<std::int64_t> point) {
  if (file.point_labels().size() == 1) {  // there is nothing to compare
    ChosenSummary only{summarise(file), {}, {}};
    only.chosen = choose_point(only.summary, point);
    return only;
  }
  ChosenSummary result{summary_without_points(file, statistics::summary_confidence), {}, {}};
  StudySummary& summary = result.summary;
  result.measures = compared_measures(table_of(file), summary.question);
  summary.points.reserve(summary.labels.size());
  const Wanted wanted{.confidence = summary.confidence, .measures = result.measures.get()};
  StudyAccumulator accumulator(file.study(), wanted, [&](PointResults&& one) {
    summary.points.push_back(only_compared(std::move(one.statistics), *result.measures));
  });
  add_trials(accumulator, file);
  accumulator.finish();
  result.chosen = choose_point(summary, point);
  complete_points(summary, file, {result.chosen.point}, false);
  return result;
}

}  // namespace

ChosenSummary summarise_chosen(const std::filesystem::path& path, std::optional<std::int64_t> point) {
  return shards::keeps_every_trial(path) ? summarise_chosen(reading::AllTrialsFile(path), point)
                                         : summarise_chosen(reading::ResultsFile(path), point);
}

}  // namespace zerocount::summary

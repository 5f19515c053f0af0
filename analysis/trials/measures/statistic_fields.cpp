#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/measures/point_columns.hpp"

namespace zerocount::measures {
namespace {

using S = const PointSummary&;

std::vector<StatisticField> outcome_count_fields() {
  return {
      {"", "trials", "1", "trials of the point", true, [](S s) { return text::to_double(s.trials); }},
      {"", "zero_count", "1", "trials whose worst move ended at zero error", true,
       [](S s) { return text::to_double(s.outcomes.zero_count); }},
      {"", "one_count", "1", "trials whose worst move ended within one count", true,
       [](S s) { return text::to_double(s.outcomes.one_count); }},
      {"", "off_target", "1",
       "trials whose worst move ended beyond one count without oscillating: neither stable nor shown unstable",
       true, [](S s) { return text::to_double(s.outcomes.off_target); }},
      {"", "oscillating", "1", "trials whose worst move ended beyond one count, oscillating", true,
       [](S s) { return text::to_double(s.outcomes.oscillating); }},
      {"", "nonfinite", "1", "trials with a move that left the finite numbers", true,
       [](S s) { return text::to_double(s.outcomes.nonfinite); }},
      {"", "open_loop", "1", "trials with $torque levels in place of targets, which are not judged", true,
       [](S s) { return text::to_double(s.outcomes.open_loop); }},
  };
}

/// The reported statistics of the jerks themselves, as opposed to measures of a move.
std::vector<StatisticField> jerk_statistic_fields() {
  return {
      {"jerk_interval", "n", "1", "intervals between the onsets of successive jerks of a move", true,
       [](S s) { return text::to_double(s.jerk_interval.n); }},
      {"jerk_interval", "mean", "s", "mean interval between successive jerks of a move", false,
       [](S s) { return s.jerk_interval.mean; }},
      {"jerk_interval", "median", "s", "median interval between successive jerks of a move", false,
       [](S s) { return s.jerk_interval.median; }},
      {"jerk_slowing", "moves", "1", "moves with 3 jerks or more", true,
       [](S s) { return text::to_double(s.jerk_slowing.moves); }},
      {"jerk_slowing", "slowing", "1", "moves with 3 jerks or more whose intervals grow (Mann-Kendall S > 0)",
       true, [](S s) { return text::to_double(s.jerk_slowing.slowing); }},
      {"jerk_slowing", "quickening", "1",
       "moves with 3 jerks or more whose intervals shrink (Mann-Kendall S < 0)", true,
       [](S s) { return text::to_double(s.jerk_slowing.quickening); }},
      {"jerk_slowing", "share", "1", "slowing moves as a proportion of the moves with 3 jerks or more", false,
       [](S s) { return s.jerk_slowing.proportion; }},
      {"jerk_slowing", "tau", "1",
       "Kendall's tau of jerk interval and its order, over the pairs within moves", false,
       [](S s) { return s.jerk_slowing.tau; }},
      {"", "jerk_agreement", "1",
       "jerks in the direction of the holding $torque as a proportion of all jerks", false,
       [](S s) { return s.jerk_agreement; }},
      {"", "jerk_one_count_share", "1", "jerks of one count as a proportion of all jerks", false,
       [](S s) { return s.jerk_one_count_share; }},
  };
}

std::vector<StatisticField> machine_fields() {
  return {
      {"machines", "n", "1", "machines that the trials ran on", true,
       [](S s) { return text::to_double(s.machines.n); }},
      {"machines", "success_sd", "1",
       "standard deviation between machines of the probability of success (beta-binomial, moment estimate)",
       false, [](S s) { return s.machines.success_sd; }},
      {"machines", "without_failure", "1",
       "machines all of whose trials succeeded, as a proportion of the machines", false,
       [](S s) { return s.machines.without_failure; }},
      {"machines", "without_failure_low", "1", "lower 95 % Clopper-Pearson bound of machines_without_failure",
       false, [](S s) { return s.machines.without_failure_bounds.low; }},
      {"machines", "without_failure_high", "1",
       "upper 95 % Clopper-Pearson bound of machines_without_failure", false,
       [](S s) { return s.machines.without_failure_bounds.high; }},
      {"machines", "worst_5_percent", "1",
       "mean success rate of the worst 5 % of the machines (of R machines the R/20 with the lowest, rounded up)",
       false, [](S s) { return s.machines.worst_5_percent; }},
  };
}

/// Appends a reported number for each statistic of a measure that `wanted` selects.
template <class Subject, class Wanted>
void add_measure(std::vector<text::ReportField<Subject>>& fields, const layout::MeasureTable& measures,
                 const layout::Measure& measure, const layout::ReportedStatistics& reported,
                 const Wanted& wanted) {
  const layout::Column& column = measure.field.column;
  const std::string stem(reported.stem.empty() ? std::string_view(column.name) : reported.stem);
  for (const StatisticKind& kind : statistic_kinds()) {
    for (const layout::StatisticText& text : reported.texts) {
      if (!wanted(kind.statistic) ||
          std::count(text.statistics.begin(), text.statistics.end(), kind.statistic) == 0)
        continue;
      std::string name(text.name.empty() ? kind.name : text.name);
      if (text.name.empty() && reported.group.empty())
        name = name.empty() ? stem : fmt::format("{}_{}", stem, name);
      fields.push_back(
          {std::string(reported.group), name, kind.statistic <= layout::Statistic::trials ? "1" : column.unit,
           fmt::format(fmt::runtime(text.long_name), meaning_of(kind), kind.bound), kind.whole,
           [row = static_cast<std::size_t>(&measure - measures.data()),
            value = kind.value](const Subject& subject) { return value(subject.measures.at(row)); },
           measure.band, measure.tolerance});
    }
  }
}

template <class Field>
void append(std::vector<Field>& fields, std::vector<Field> more) {
  std::move(more.begin(), more.end(), std::back_inserter(fields));
}

bool is_count(layout::Statistic statistic) {
  return statistic == layout::Statistic::count;
}
bool is_bootstrap(layout::Statistic statistic) {
  return statistic >= layout::Statistic::bootstrap_low;
}
bool is_any_other(layout::Statistic statistic) {
  return !is_count(statistic) && !is_bootstrap(statistic);
}

}  // namespace

std::vector<StatisticField> statistic_fields(const study::StudyFeatures& features,
                                             const layout::MeasureTable& measures) {
  std::vector<StatisticField> fields = outcome_count_fields();
  const auto add = [&](const layout::Measure& measure, bool (*wanted)(layout::Statistic)) {
    add_measure(fields, measures, measure, measure.point, wanted);
  };
  const std::vector<const layout::Measure*> ordered =
      layout::measures_of(measures, layout::ReportOrder::statistics,
                          [](const layout::Measure& m) { return m.only_with == nullptr; });
  for (const layout::Measure* measure : ordered) add(*measure, is_count);
  for (const layout::Measure* measure : ordered) {
    add(*measure, is_any_other);
    if (measure->field.column.name == "jerk_count") append(fields, jerk_statistic_fields());
  }
  if (features.machines) append(fields, machine_fields());
  for (const layout::Measure& measure : measures) {
    if (measure.only_with != nullptr && layout::is_in_file(measure, features))
      add(measure, [](layout::Statistic statistic) { return !is_bootstrap(statistic); });
  }
  return fields;
}

std::vector<StatisticField> mean_bound_fields(const study::StudyFeatures& features,
                                              const layout::MeasureTable& measures) {
  std::vector<StatisticField> fields;
  for (const layout::Measure& measure : measures) {
    const auto only_with = measure.only_with;
    if (only_with == nullptr || features.*only_with)
      add_measure(fields, measures, measure, measure.point, is_bootstrap);
  }
  return fields;
}

std::vector<LevelField> level_fields(const layout::MeasureTable& measures) {
  std::vector<LevelField> fields{
      {"", "n", "1", "trials whose motion was not lost, of which the values of the level are", true,
       [](const LevelStatistics& s) { return text::to_double(s.of(&trial::MoveOutcome::holding_torque).n); }},
      {"", "nonfinite", "1", "trials whose motion was lost in the level or before", true,
       [](const LevelStatistics& s) { return text::to_double(s.nonfinite); }}};
  for (const layout::Measure* measure :
       layout::measures_of(measures, layout::ReportOrder::levels,
                           [](const layout::Measure& m) { return !m.level.texts.empty(); })) {
    add_measure(fields, measures, *measure, measure->level, [](layout::Statistic) { return true; });
  }
  return fields;
}

std::vector<const layout::Measure*> counted_qualities(const study::StudyFeatures& features,
                                                      const layout::MeasureTable& measures) {
  std::vector<const layout::Measure*> counted = layout::measures_of(
      measures, layout::ReportOrder::statistics,
      [](const layout::Measure& m) { return reports(m.point, layout::Statistic::count); });
  std::erase_if(counted, [&](const layout::Measure* m) { return !layout::is_in_file(*m, features); });
  return counted;
}

}  // namespace zerocount::measures

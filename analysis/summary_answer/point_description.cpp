#include "analysis/summary_answer/point_description.hpp"

#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "analysis/measures/field_description.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary_answer/parts.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

std::vector<std::pair<std::string, AxisValue>> values_of_axes(Point p) {
  std::vector<std::pair<std::string, AxisValue>> values;
  for (const study::SweepAxis& axis : p.summary.axes) values.emplace_back(axis.name, value_at(axis, p));
  return values;
}

const measures::PointSummary& statistics_of(Point p) {
  return p.statistics();
}

void add_statistics(PointDescription& point, const summary::StudySummary& summary) {
  std::vector<measures::StatisticField> fields, of_bands, of_tolerances;
  for (std::vector<measures::StatisticField> all :
       {measures::statistic_fields(summary.features, summary.table()),
        measures::mean_bound_fields(summary.features, summary.table())}) {
    for (measures::StatisticField& field : all)
      (field.band ? of_bands : field.tolerance ? of_tolerances : fields).push_back(std::move(field));
  }
  measures::add_fields(point, fields, summary.features.axis, statistics_of);
  const parameters::AxisKind axis = summary.features.axis;
  measures::add_by_limit(point, of_bands, measures::list_of_bands(), axis, statistics_of);
  measures::add_by_limit(point, of_tolerances, measures::list_of_tolerances(axis), axis, statistics_of);
}

/// A move of the trials of a point.
struct MoveReading {
  const measures::PointSummary& point;
  std::size_t move;
};

void add_moves(PointDescription& point, const summary::StudySummary& summary) {
  using Move = const MoveReading&;
  document::Description<MoveReading> move;
  for (const layout::FlagMeaning& outcome : layout::outcome_labels()) {
    move.value({.key = outcome.word, .meaning = "trials with this outcome of the move"},
               [counter = measures::counter_of(static_cast<trial::Outcome>(outcome.value))](Move m) {
                 return m.point.by_move[m.move].*counter;
               });
  }
  for (const layout::Measure* quality : measures::counted_qualities(summary.features, summary.table())) {
    move.value({.key = quality->field.column.name, .meaning = "trials whose move has this quality"},
               [quality](Move m) { return m.point.of(*quality).by_move.at(m.move); });
  }
  point.table({.key = "moves", .meaning = "counts of trials by move", .shown = Shown::in_json}, move,
              [](Point p) {
                std::vector<MoveReading> moves;
                for (std::size_t i = 0; i < p.statistics().by_move.size(); ++i)
                  moves.push_back({p.statistics(), i});
                return moves;
              });
}

void add_levels(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.features.open_loop) return;
  point.table({.key = "levels", .meaning = "the torque levels", .shown = Shown::in_json},
              level_description(summary), [](Point p) {
                std::vector<LevelReading> levels;
                for (std::size_t i = 0; i < p.statistics().levels.size(); ++i) levels.push_back({p, i});
                return levels;
              });
}

theory::PointPrediction prediction_at(Point p) {
  return p.summary.predictions.empty() ? theory::PointPrediction{} : p.summary.predictions[p.index()];
}

/// The proportion of trials to which the criteria apply.
auto proportion_of(std::int64_t theory::PointPrediction::*trials) {
  return [trials](const theory::PointPrediction& prediction) {
    return statistics::rate(prediction.*trials, theory::predicted_trials(prediction));
  };
}

void add_prediction(PointDescription& point, const summary::StudySummary& summary) {
  using P = theory::PointPrediction;
  if (!summary.predictions.empty()) {
    document::Description<P> object;
    object.value({.key = "trials", .meaning = "trials of the point"}, &P::trials)
        .value({.key = "stable", .meaning = "trials in which criterion (6) holds"}, &P::stable)
        .value({.key = "unstable", .meaning = "trials in which criterion (7) is exceeded"}, &P::unstable)
        .value({.key = "stable_share", .meaning = "stable as a proportion of trials", .unit = "1"},
               proportion_of(&P::stable))
        .value({.key = "unstable_share", .meaning = "unstable as a proportion of trials", .unit = "1"},
               proportion_of(&P::unstable))
        .value({.key = "verdict", .meaning = "what the criteria predict"},
               [](const P& prediction) { return theory::verdict(prediction); });
    point.object({.key = "prediction", .meaning = "by the paper's criteria", .shown = Shown::in_json}, object,
                 prediction_at);
  }
  for (const measures::PredictionField& field : measures::prediction_fields())
    point.value({.key = std::string(field.name),
                 .meaning = std::string(field.long_name),
                 .unit = "1",
                 .shown = Shown::in_csv},
                [trials = field.trials](Point p) { return proportion_of(trials)(prediction_at(p)); });
  point.value({.key = "predicted", .meaning = "what the criteria predict", .shown = Shown::in_csv},
              [](Point p) { return theory::verdict(prediction_at(p)); });
}

std::optional<std::string> observed_on_rig(Point p) {
  const std::string seen = summary::observed_at(p.summary, p.point);
  return seen.empty() ? std::nullopt : std::optional(seen);
}

}  // namespace

document::Description<PointReading> point_description(const summary::StudySummary& summary) {
  PointDescription point;
  point
      .value({.key = "point", .meaning = "number of the design point", .shown = Shown::in_data},
             &PointReading::point)
      .value({.key = "label", .meaning = "label of the design point", .shown = Shown::in_data},
             &PointReading::label);
  point.value({.key = "axes",
               .meaning = "values of the swept parameters; null where one has a distribution",
               .shown = Shown::in_json},
              values_of_axes);
  add_axes(point, summary, [](Point p) -> const PointReading& { return p; });
  if (!summary.features.open_loop) add_swept_columns(point, summary);
  add_goal(point, summary);
  add_statistics(point, summary);
  add_moves(point, summary);
  add_levels(point, summary);
  if (!summary.features.open_loop) add_question_columns(point, summary);
  add_prediction(point, summary);
  point.value({.key = "observed",
               .heading = "observed",
               .meaning = "what was observed on the real rig",
               .shown = summary.features.open_loop ? Shown::in_data : Shown::everywhere},
              observed_on_rig);
  add_undecided(point, summary);
  add_observed(point, summary);
  add_repeatability(point, summary);
  add_stopping(point, summary);
  add_worlds(point, summary);
  add_claims(point, summary);
  add_conditions(point, summary);
  add_ages(point, summary);
  add_assurance(point, summary);
  return point;
}

AxisValue value_at(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return axis.texts[p.index()];
  return axis.numbers[p.index()];
}

std::string legend_of(const std::vector<document::Item>& columns) {
  std::string legend;
  for (const document::Item& column : columns) {
    if (column.shown == Shown::to_people && !column.meaning.empty()) legend += column.meaning + '\n';
  }
  return legend;
}

}  // namespace zerocount::summary_answer

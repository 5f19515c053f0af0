#include "analysis/summary_answer/point_description.hpp"

#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/measures/field_description.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary_answer/parts.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

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

/// Columns for people where the criteria apply to some trial.
void add_prediction(PointDescription& point, const summary::StudySummary& summary) {
  using P = theory::PointPrediction;
  const auto proportion = [](const char* heading, std::string_view column, const char* key,
                             const char* meaning) {
    return document::Item{.key = key,
                          .heading = heading,
                          .meaning = meaning,
                          .unit = "1",
                          .notation = document::Notation::percent,
                          .column = std::string(column)};
  };
  const std::span<const measures::PredictionField> fields = measures::prediction_fields();
  document::Description<P> object;
  object.value({.key = "trials", .meaning = "trials of the point", .shown = Shown::in_json}, &P::trials)
      .value({.key = "stable", .meaning = "trials in which criterion (6) holds", .shown = Shown::in_json},
             &P::stable)
      .value({.key = "unstable",
              .meaning = "trials in which criterion (7) is exceeded",
              .shown = Shown::in_json},
             &P::unstable)
      .value(proportion("(6) holds", fields[0].name, "stable_share",
                        "proportion of trials in which the paper's criterion (6) holds, which promises "
                        "stability before sliding; by the friction where the trial starts"),
             proportion_of(&P::stable))
      .value(proportion("(7) exceeded", fields[1].name, "unstable_share",
                        "proportion of trials in which its criterion (7) is exceeded, which rules it out"),
             proportion_of(&P::unstable))
      .value({.key = "verdict", .meaning = "what the criteria predict", .column = "predicted"},
             [](const P& prediction) { return theory::verdict(prediction); });
  point.object({.key = "prediction",
                .meaning = "by the paper's criteria",
                .shown = summary.predictions.empty() ? Shown::in_csv : Shown::everywhere,
                .optional = true,
                .own_table = zero_count_table(summary)},
               object, prediction_at);
}

std::optional<std::string> observed_on_rig(Point p) {
  const std::string seen = summary::observed_at(p.summary, p.point);
  return seen.empty() ? std::nullopt : std::optional(seen);
}

/// Columns for people that explain themselves, with their meaning; those of a group stand in the group.
void add_legend(std::string& legend, const std::vector<document::Item>& columns) {
  for (const document::Item& column : columns) {
    if (!document::is_shown(column.shown, document::Audience::people)) continue;
    if (column.kind == document::Kind::object) {
      add_legend(legend, column.members);
    } else if (column.kind != document::Kind::table && !column.heading.empty() && !column.meaning.empty() &&
               !column.names_row) {
      legend += column.shown == Shown::to_people ? column.meaning + '\n'
                                                 : fmt::format("{}: {}\n", column.heading, column.meaning);
    }
  }
}

}  // namespace

PointDescription point_description(const summary::StudySummary& summary) {
  PointDescription point;
  add_axes(point, summary);
  add_goal(point, summary);
  add_statistics(point, summary);
  add_moves(point, summary);
  add_levels(point, summary);
  if (!summary.features.open_loop) add_question_columns(point, summary);
  add_prediction(point, summary);
  point.value({.key = "observed", .heading = "observed", .meaning = "what was observed on the real rig"},
              observed_on_rig);
  add_undecided(point, summary);
  add_observed(point, summary);
  add_repeatability(point, summary);
  add_stopping(point, summary);
  add_cells(point, summary);
  add_assurance(point, summary);
  return point;
}

std::string legend_of(const std::vector<document::Item>& columns) {
  std::string legend;
  add_legend(legend, columns);
  return legend;
}

}  // namespace zerocount::summary_answer

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/measures/field_description.hpp"
#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/point_names.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/text.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

/// More swept parameters than this make the table too wide: the labels alone tell the points apart.
constexpr std::size_t max_swept_columns = 4;

std::string shown_value(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return text::printable(axis.texts[p.index()]);
  const double value = axis.numbers[p.index()];
  if (std::isnan(value)) return "random";
  const auto row = parameters::find_parameter(axis.name);
  if (row && parameters::parameter_table()[*row].none == value) return "none";
  return fmt::format("{:.6g}", value);
}

/// Whether the labels are those of a grid, which name its values: "fast, controller.kp=0.0003".
bool labels_name_values(const summary::StudySummary& summary,
                        const std::vector<const study::SweepAxis*>& swept) {
  return std::ranges::any_of(swept, [&](const study::SweepAxis* axis) {
    return std::ranges::all_of(summary.labels, [axis](const std::string& label) {
      return label.find(axis->name + "=") != std::string::npos;
    });
  });
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

std::function<std::string(Point)> short_label(const summary::StudySummary& summary) {
  return [labels = std::make_shared<const std::vector<std::string>>(summary::short_labels(
              summary.labels, summary.axes))](Point p) { return text::printable((*labels)[p.index()]); };
}

PointDescription labelled_points(const summary::StudySummary& summary) {
  return PointDescription().value({.heading = "point"}, short_label(summary));
}

void add_axes(PointDescription& point, const summary::StudySummary& summary) {
  std::vector<const study::SweepAxis*> shown = summary::varying_parameters(summary.axes);
  if (shown.size() > max_swept_columns) shown.clear();
  const bool by_number = labels_name_values(summary, shown);
  const auto label = short_label(summary);
  point
      .value({.key = "point",
              .heading = "point",
              .meaning = "number of the design point, for people its label; *: the headline speaks of it"},
             &PointReading::point)
      .shown_as([by_number, label](Point p) {
        return (by_number ? fmt::format("{}", p.point) : label(p)) + (p.marked ? " *" : "");
      })
      .value({.key = "label", .heading = "point", .meaning = "label of the design point", .names_row = true},
             &PointReading::label)
      .shown_as(label)
      .value({.key = "axes",
              .meaning = "values of the swept parameters; null where one has a distribution",
              .shown = document::Shown::in_json},
             [](Point p) {
               std::vector<std::pair<std::string, AxisValue>> values;
               for (const study::SweepAxis& axis : p.summary.axes)
                 values.emplace_back(axis.name, value_at(axis, p));
               return values;
             });
  for (const study::SweepAxis& axis : summary.axes) {
    const bool is_shown = axis.name == "case" ? by_number : std::ranges::find(shown, &axis) != shown.end();
    point
        .value({.key = axis.name,
                .heading = is_shown ? summary::short_name(summary.axes, axis) : "",
                .meaning = axis.meaning,
                .unit = axis.unit,
                .shown = is_shown ? document::Shown::not_in_json : document::Shown::in_csv,
                .numeric = axis.kind == study::SweepAxis::Kind::number},
               [&axis](Point p) { return value_at(axis, p); })
        .shown_as([&axis](Point p) { return shown_value(axis, p); });
  }
}

AxisValue value_at(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return axis.texts[p.index()];
  return axis.numbers[p.index()];
}

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

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/measure_statistics.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using Point = const DescribedPoint&;

/// Largest number of swept parameters with columns of their own. With more, the table would be too wide, and
/// only the labels identify the points.
constexpr std::size_t max_swept_columns = 4;

std::string shown_value(const study::SweepAxis& axis, Point p) {
  if (axis.kind == study::SweepAxis::Kind::text) return text::printable(axis.texts[p.index()]);
  const double value = axis.numbers[p.index()];
  if (std::isnan(value)) return "random";
  const auto row = parameters::find_parameter(axis.name);
  if (row && parameters::parameter_table()[*row].none == value) return "none";
  return fmt::format("{:.6g}", value);
}

/// Whether the labels of the design points name swept values, as those of a grid do: "fast,
/// controller.kp=0.0003".
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

/// A move (the same number in the sequence of targets) over all trials of a design point.
struct MoveAtPoint {
  const measures::PointSummary& point;
  std::size_t move;
};

void add_moves(PointDescription& point, const summary::StudySummary& summary) {
  using Move = const MoveAtPoint&;
  document::Description<MoveAtPoint> move;
  for (const layout::FlagMeaning& outcome : layout::outcome_labels()) {
    move.value(document::in_data(outcome.word, "trials with this outcome of the move"),
               [counter = measures::counter_of(static_cast<trial::Outcome>(outcome.value))](Move m) {
                 return m.point.by_move[m.move].*counter;
               });
  }
  for (const layout::Measure* quality : measures::counted_qualities(summary.features, summary.table())) {
    move.value(document::in_data(quality->field.column.name, "trials whose move has this quality"),
               [quality](Move m) { return m.point.of(*quality).by_move.at(m.move); });
  }
  point.table(in_json("moves", "counts of trials by move"), move, [](Point p) {
    std::vector<MoveAtPoint> moves;
    for (std::size_t i = 0; i < p.statistics().by_move.size(); ++i) moves.push_back({p.statistics(), i});
    return moves;
  });
}

void add_levels(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.features.open_loop) return;
  point.table(in_json("levels", "the torque levels"), level_description(summary), [](Point p) {
    std::vector<LevelAtPoint> levels;
    for (std::size_t i = 0; i < p.statistics().levels.size(); ++i) levels.push_back({p, i});
    return levels;
  });
}

theory::PointPrediction prediction_at(Point p) {
  return p.summary.predictions.empty() ? theory::PointPrediction{} : p.summary.predictions[p.index()];
}

/// A function that returns a count of PointPrediction as a proportion of the trials to which the stability
/// criteria apply.
/// @param trials member with the count
auto proportion_of(std::int64_t theory::PointPrediction::*trials) {
  return [trials](const theory::PointPrediction& prediction) {
    return statistics::rate(prediction.*trials, theory::predicted_trials(prediction));
  };
}

/// Adds the predictions of the stability criteria to a design point; people see their columns if the criteria
/// apply to some trial.
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
  object.value(in_json("trials", "trials of the point"), &P::trials)
      .value(in_json("stable", "trials in which criterion (6) holds"), &P::stable)
      .value(in_json("unstable", "trials in which criterion (7) is exceeded"), &P::unstable)
      .value(
          proportion(
              "(6) holds", fields[0].name, "stable_share",
              "proportion of trials in which the paper's criterion (6) holds, which promises stability before sliding; "
              "by the friction where the trial starts"),
          proportion_of(&P::stable))
      .value(proportion("(7) exceeded", fields[1].name, "unstable_share",
                        "proportion of trials in which its criterion (7) is exceeded, which rules it out"),
             proportion_of(&P::unstable))
      .value({.key = "verdict", .meaning = "what the criteria predict", .column = "predicted"},
             [](const P& prediction) { return theory::verdict(prediction); });
  point.object({.key = "prediction",
                .meaning = "by the paper's criteria",
                .shown = summary.predictions.empty() ? Visibility::in_csv : Visibility::everywhere,
                .optional = true,
                .own_table = zero_count_table(summary)},
               object, prediction_at);
}

std::optional<std::string> observed_on_machine(Point p) {
  const std::string seen = summary::observed_at(p.summary, p.point);
  return seen.empty() ? std::nullopt : std::optional(seen);
}

/// Appends the meanings of the columns that people see to the legend, including the columns of nested
/// objects.
void add_legend(std::string& legend, const std::vector<document::Item>& columns) {
  for (const document::Item& column : columns) {
    if (!document::is_shown(column.shown, document::Audience::people)) continue;
    if (column.kind == document::Kind::object) {
      add_legend(legend, column.members);
    } else if (column.kind != document::Kind::table && !column.heading.empty() && !column.meaning.empty() &&
               !column.names_row) {
      legend += column.shown == Visibility::to_people
                    ? column.meaning + '\n'
                    : fmt::format("{}: {}\n", column.heading, column.meaning);
    }
  }
}

}  // namespace

std::function<std::string(Point)> short_label(const summary::StudySummary& summary) {
  return [labels = std::make_shared<const std::vector<std::string>>(summary::short_labels(
              summary.labels, summary.axes))](Point p) { return text::printable((*labels)[p.index()]); };
}

void add_axes(PointDescription& point, const summary::StudySummary& summary) {
  std::vector<const study::SweepAxis*> shown = summary::varying_parameters(summary.axes);
  if (shown.size() > max_swept_columns) shown.clear();
  const bool by_number = labels_name_values(summary, shown);
  const auto label = short_label(summary);
  point
      .value({"point", "point",
              "number of the design point, for people its label; *: the headline speaks of it"},
             &DescribedPoint::point)
      .shown_as([by_number, label](Point p) {
        return (by_number ? fmt::format("{}", p.point) : label(p)) + (p.marked ? " *" : "");
      })
      .value({.key = "label", .heading = "point", .meaning = "label of the design point", .names_row = true},
             &DescribedPoint::label)
      .shown_as(label)
      .value(in_json("axes", "values of the swept parameters; null where one has a distribution"),
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
                .shown = is_shown ? document::Visibility::not_in_json : document::Visibility::in_csv,
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
  point.value({"observed", "observed", "what was observed on the real machine"}, observed_on_machine);
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

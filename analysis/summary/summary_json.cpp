#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "analysis/measures/point_columns.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/summary/chosen_point.hpp"
#include "analysis/summary/summary_parts.hpp"
#include "analysis/text/report_json.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::summary {
namespace {

nlohmann::ordered_json axes_json(const StudySummary& summary, std::size_t point) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::object();
  for (const study::SweepAxis& axis : summary.axes) {
    if (axis.kind == study::SweepAxis::Kind::text) {
      axes[axis.name] = axis.texts[point];
    } else {
      axes[axis.name] = axis.numbers[point];
    }
  }
  return axes;
}

nlohmann::ordered_json moves_json(const measures::PointSummary& statistics,
                                  const study::StudyFeatures& features) {
  nlohmann::ordered_json moves = nlohmann::ordered_json::array();
  const std::vector<const layout::Measure*> qualities =
      measures::counted_qualities(features, *statistics.table);
  for (std::size_t move = 0; move < statistics.by_move.size(); ++move) {
    nlohmann::ordered_json counts;
    for (const layout::FlagMeaning& outcome : layout::outcome_labels()) {
      counts[outcome.word] =
          statistics.by_move[move].*measures::counter_of(static_cast<trial::Outcome>(outcome.value));
    }
    for (const layout::Measure* measure : qualities)
      counts[measure->field.column.name] = statistics.of(*measure).by_move.at(move);
    moves.push_back(std::move(counts));
  }
  return moves;
}

nlohmann::ordered_json prediction_json(const theory::PointPrediction& prediction) {
  return {{"trials", prediction.trials},
          {"stable", prediction.stable},
          {"unstable", prediction.unstable},
          {"stable_share", statistics::rate(prediction.stable, theory::predicted_trials(prediction))},
          {"unstable_share", statistics::rate(prediction.unstable, theory::predicted_trials(prediction))},
          {"verdict", theory::verdict(prediction)}};
}

}  // namespace

nlohmann::ordered_json summary_json(const StudySummary& summary, const SummaryForm& form) {
  require_consistent(summary);
  const std::vector<measures::StatisticField> fields =
      measures::statistic_fields(summary.features, summary.table());
  const std::vector<measures::StatisticField> bounds =
      measures::mean_bound_fields(summary.features, summary.table());
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const std::int64_t index : points_shown(summary, form)) {
    const auto i = static_cast<std::size_t>(index);
    nlohmann::ordered_json point{
        {"point", index}, {"label", summary.labels[i]}, {"axes", axes_json(summary, i)}};
    text::add_fields(point, fields, summary.points[i]);
    text::add_fields(point, bounds, summary.points[i]);
    point["moves"] = moves_json(summary.points[i], summary.features);
    if (summary.features.open_loop) point["levels"] = levels_json(summary.points[i]);
    if (!summary.predictions.empty()) point["prediction"] = prediction_json(summary.predictions[i]);
    if (const std::string seen = observed_at(summary, static_cast<std::int64_t>(i)); !seen.empty()) {
      point["observed"] = seen;
    }
    for (const measures::SummarySection& section : summary.sections) point[section.key] = section.json[i];
    points.push_back(std::move(point));
  }
  nlohmann::ordered_json json{{"name", summary.name},
                              {"design", summary.design},
                              {"conservative_bounds", summary.features.spread_trials},
                              {"confidence", summary.confidence}};
  if (const auto& unfinished = summary.unfinished)
    json["unfinished"] = {{"finished", unfinished->finished}, {"trials", unfinished->trials}};
  if (!summary.features.open_loop)
    json["best"] = chosen_point_json(summary, choose_point(summary, form.chosen));
  json["points"] = std::move(points);
  return json;
}

std::string summary_json_text(const StudySummary& summary) {
  return text::json_text(summary_json(summary));
}

}  // namespace zerocount::summary

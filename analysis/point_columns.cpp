#include "analysis/point_columns.hpp"

#include <string>
#include <utility>

#include "analysis/proportion.hpp"
#include "analysis/statistic_fields.hpp"

namespace zerocount {

std::vector<PointColumn> point_columns(std::span<const PointSummary> points) {
  std::vector<PointColumn> columns;
  for (const StatisticField& field : statistic_fields()) {
    PointColumn column{flat_name(field), std::string(field.unit), std::string(field.long_name), {}};
    for (const PointSummary& point : points) column.values.push_back(field.value(point));
    columns.push_back(std::move(column));
  }
  return columns;
}

std::vector<PointColumn> prediction_columns(std::span<const TheoryPrediction> predictions) {
  PointColumn stable{
      "predicted_stable_share", "1", "trials in which criterion (6) holds, as a share of trials", {}};
  PointColumn unstable{
      "predicted_unstable_share", "1", "trials in which criterion (7) is exceeded, as a share of trials", {}};
  for (const TheoryPrediction& prediction : predictions) {
    stable.values.push_back(rate(prediction.stable, prediction.trials));
    unstable.values.push_back(rate(prediction.unstable, prediction.trials));
  }
  return {std::move(stable), std::move(unstable)};
}

}  // namespace zerocount

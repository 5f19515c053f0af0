#include "runners/assemble.hpp"

#include <vector>

#include "analysis/point_columns.hpp"
#include "analysis/study_statistics.hpp"
#include "results/shards/merge.hpp"

namespace zerocount {

void assemble(std::span<const ShardInfo> shards, const Study& study, const std::filesystem::path& output,
              RowRange rows) {
  const auto statistics = [&](const StudyFile& file) {
    std::vector<PointColumn> columns = point_columns(study_statistics(file));
    const std::vector<PointColumn> predictions = prediction_columns(study_predictions(study));
    columns.insert(columns.end(), predictions.begin(), predictions.end());
    return columns;
  };
  merge_shards(shards, study, output, rows, statistics);
}

}  // namespace zerocount

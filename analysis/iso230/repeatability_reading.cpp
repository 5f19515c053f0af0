#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/iso230/repeatability_columns.hpp"
#include "analysis/iso230/repeatability_file.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::iso230 {
namespace {

void require_rows(const layout::TableIo& io, std::int64_t rows) {
  if (io.rows() != rows) io.row_scale().fail("it is not of all trials of the study");
}

/// The trials of one point, column by column.
struct PointReader {
  const layout::TableIo& axis_table;
  const layout::TableIo& target_table;
  std::int64_t first;  ///< row
  std::int64_t trials;

  std::int64_t evaluated() const {
    std::vector<std::uint8_t> flags(static_cast<std::size_t>(trials));
    axis_table.column(0).read(first, trials, flags.data());
    return std::count(flags.begin(), flags.end(), std::uint8_t{1});
  }

  /// [trial], of an axis value.
  std::vector<double> axis(std::size_t source, std::size_t field) const {
    std::vector<double> values(static_cast<std::size_t>(trials));
    axis_table.column(1 + source * axis_fields().size() + field).read(first, trials, values.data());
    return values;
  }

  /// [target][trial], of the column of the table of targets.
  std::vector<std::vector<double>> target_column(std::size_t column) const {
    const auto width = static_cast<std::size_t>(target_table.width());
    std::vector<double> values(static_cast<std::size_t>(trials) * width);
    target_table.column(column).read(first, trials, values.data());
    std::vector<std::vector<double>> by_target(width);
    for (std::size_t i = 0; i < values.size(); ++i) by_target[i % width].push_back(values[i]);
    return by_target;
  }
};

SourceRepeatability source_statistics(const PointReader& reader, std::size_t source, std::size_t targets,
                                      double confidence) {
  SourceRepeatability result;
  for (std::size_t field = 0; field < axis_fields().size(); ++field) {
    result.axis.push_back(statistics_of(reader.axis(source, field), confidence));
  }
  result.targets.resize(targets);
  for (std::size_t field = 0; field < target_fields().size(); ++field) {
    std::vector<std::vector<double>> values =
        reader.target_column(1 + source * target_fields().size() + field);
    for (std::size_t target = 0; target < targets; ++target) {
      result.targets[target].push_back(statistics_of(std::move(values[target]), confidence));
    }
  }
  return result;
}

/// The axis value whose zeros are counted: R, or that of the only direction.
std::size_t overall_repeatability(const SequenceShape& shape) {
  const auto wanted = shape.positive && shape.negative ? &AxisRepeatability::repeatability
                      : shape.positive                 ? &AxisRepeatability::repeatability_positive
                                                       : &AxisRepeatability::repeatability_negative;
  const auto fields = axis_fields();
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [wanted](const auto& field) { return field.value == wanted; });
  return static_cast<std::size_t>(found - fields.begin());
}

PointRepeatability point_statistics(const PointReader& reader, const SequenceShape& shape,
                                    std::int64_t trials, double confidence) {
  const auto targets = static_cast<std::size_t>(shape.targets);
  constexpr std::size_t encoder = 1;  // of deviation_sources()
  PointRepeatability point;
  point.trials = trials;
  point.evaluated = reader.evaluated();
  if (shape.cycles >= 2) {
    const std::vector<double> values = reader.axis(encoder, overall_repeatability(shape));
    const std::int64_t zero = std::count(values.begin(), values.end(), 0.0);
    point.zero_repeatability = zero;
    point.zero_rate = statistics::rate(zero, trials);
    point.zero_bounds = statistics::clopper_pearson(zero, trials, confidence);
  }
  for (const std::vector<double>& positions : reader.target_column(0)) {
    statistics::Moments& moments = point.positions.emplace_back();
    for (const double position : positions) moments.add(position);
  }
  for (std::size_t source = 0; source < deviation_sources().size(); ++source) {
    point.sources.push_back(source_statistics(reader, source, targets, confidence));
  }
  return point;
}

}  // namespace

RepeatabilitySummary read_repeatability(const hdf5::Group& root, const study::Study& study,
                                        double confidence) {
  const layout::TableIo axis = layout::TableIo::open(root, trial_table_of_axis());
  const layout::TableIo targets = layout::TableIo::open(root, trial_table_of_targets());
  RepeatabilitySummary summary{confidence, shape_of(study.sequence), {}, study.units.axis};
  require_rows(axis, study::trial_count(study));
  require_rows(targets, study::trial_count(study));
  if (targets.width() != summary.shape.targets)
    targets.row_scale().fail("it is of another number of targets");
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    const PointReader reader{axis, targets, point * study.trials, study.trials};
    summary.points.push_back(point_statistics(reader, summary.shape, study.trials, confidence));
  }
  return summary;
}

RepeatabilitySummary study_repeatability(const reading::StudyFile& file, const study::Study& study,
                                         double confidence) {
  return read_repeatability(hdf5::File::open_to_read(file.path()), study, confidence);
}

}  // namespace zerocount::iso230

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/measures/point_statistics.hpp"
#include "analysis/trials/summary/study_statistics.hpp"
#include "core/friction/profile.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/study/group_inputs.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/measure_table.hpp"
#include "results/shards/trial_columns.hpp"
#include "runners/forecast/forecast.hpp"

namespace zerocount::forecast {
namespace {

/// Bytes that a dataset takes in a results file without its values: its header, attributes, index and its
/// entry in the group. Measured.
constexpr double bytes_of_dataset = 3050.0;

/// Function that returns, for the trial of row i, the first row whose trial has the same random draws at this
/// level, such as the trials of the same machine. For a level at which nothing repeats: row i itself.
std::function<std::int64_t(std::int64_t)> twins_of(const study::Study& study, study::DrawLevel level) {
  const bool has_twins =
      level != study::DrawLevel::study && (level < study::DrawLevel::trial || !study.independent_points);
  return [&study, level, has_twins, indices = study::trial_indices(study)](std::int64_t row) {
    if (!has_twins) return row;
    return indices.trial_of(indices.draw_of(row % study.trials) % study::draw_count(study, level), 0);
  };
}

/// Estimated bytes of the tables of the trials that the file keeps.
double bytes_of_trials(const study::Study& study, const TrialSample& sample) {
  std::vector<shards::TrialResult> trials = sample.trials;
  const auto all = static_cast<double>(study::trial_count(study));
  if (layout::has_sums(study.retention))
    std::erase_if(trials, [](const shards::TrialResult& one) { return trial::succeeded(one.outcome.moves); });
  if (trials.empty()) return 0.0;
  const double scale = sample.kept * all / static_cast<double>(trials.size());
  const layout::MeasureTable& measures = layout::measure_table(study.features);
  const std::vector<shards::ShardTable> tables = shards::shard_tables(study, measures);
  const shards::TrialColumns columns = shards::columns_of(study, measures, trials);
  constexpr double bytes_of_row_number = 8.0 * 0.005;  // they rise by one; measured
  double bytes = 3.0 * bytes_of_row_number * sample.kept * all;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const std::vector<layout::Column>& described = tables[t].table.columns;
    // Of the table of trials, its numbers are counted above, and its inputs repeat.
    for (std::size_t i = t == 0 ? 2 : 0; i < described.size(); ++i) {
      const std::vector<std::byte>& values = columns.tables[t].columns[i];
      const double elements =
          static_cast<double>(values.size()) / static_cast<double>(hdf5::size_of(described[i].element));
      const bool repeats = t == 0 && !layout::has_sums(study.retention);
      const bool of_trials = tables[t].table.rows.name == "trial" && !layout::has_sums(study.retention);
      const double period =
          of_trials ? static_cast<double>(study.trials) * elements / static_cast<double>(trials.size()) : 0.0;
      bytes += stored_bytes({described[i].element, values, period}, scale * elements,
                            repeats ? twins_of(study, study.columns.inputs[i - 2].level)
                                    : std::function<std::int64_t(std::int64_t)>());
    }
  }
  return bytes;
}

/// Estimated bytes of the sample-by-sample records (traces) of the retained trials.
double bytes_of_records(const study::Study& study, const TrialSample& sample) {
  if (sample.traced.empty()) return 0.0;
  const auto retained = static_cast<double>(std::ssize(study.retained_trials) * study::point_count(study));
  const shards::TrialColumns columns =
      shards::columns_of(study, layout::measure_table(study.features), sample.traced);
  const std::vector<layout::Column> described = layout::trace_table(study.features).columns;
  double bytes = 0.0;
  for (std::size_t i = 0; i < described.size(); ++i)
    bytes += stored_bytes(described[i].element, columns.tables.back().columns[i]);
  return bytes * retained / static_cast<double>(sample.traced.size());
}

double stored_reals(const std::vector<double>& values) {
  return stored_bytes(hdf5::Element::float64, std::as_bytes(std::span(values)));
}

/// Estimated bytes of all friction profiles (friction that varies along the axis), from the profiles of some
/// machines.
double bytes_of_profiles(const study::Study& study) {
  constexpr std::int64_t max_machines = 4;
  double bytes = 0.0;
  for (const study::RealisedProfile& realised : study.profiles) {
    const std::int64_t machines = realised.of_machine ? study.machines : 1;
    const std::int64_t tried = std::min(machines, max_machines);
    const std::int64_t angles =
        realised.of_machine ? layout::profile_angles_of_machine(realised.profile->cosine.size(), machines)
                            : layout::profile_angles;
    std::vector<double> values;
    for (std::int64_t machine = 0; machine < tried; ++machine) {
      const auto rotor = realised.of_machine ? realised.of_machine(machine) : realised.profile;
      for (std::int64_t i = 0; i < angles; ++i)
        values.push_back(
            friction::value_at(*rotor, study.period * static_cast<double>(i) / static_cast<double>(angles)));
    }
    // The angles themselves are stored once.
    bytes += stored_reals(values) * static_cast<double>(machines) / static_cast<double>(tried) +
             8.0 * static_cast<double>(angles);
  }
  return bytes;
}

/// Estimated bytes of the inputs of machines and of their counts of successes.
double bytes_of_machines(const study::Study& study) {
  constexpr std::int64_t max_machines = 128;
  const std::int64_t tried = std::min(study.machines, max_machines);
  std::vector<std::vector<double>> columns(study.columns.shared[study::Grouping::machine].size());
  for (std::int64_t machine = 0; machine < tried && !columns.empty(); ++machine) {
    const std::vector<double> inputs = study::group_inputs(study, study::Grouping::machine, machine);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(inputs[i]);
  }
  double bytes = 0.0;
  for (const std::vector<double>& column : columns)
    bytes += stored_bytes({.element = hdf5::Element::float64, .values = std::as_bytes(std::span(column))},
                          static_cast<double>(study.machines));
  constexpr double bytes_of_count = 0.25;  // of the successes of a machine at a point; measured
  return bytes + bytes_of_count * static_cast<double>(study.machines * study::point_count(study));
}

/// Trials of the sample in groups that each represent one design point, with equally many trials each.
std::vector<std::span<const shards::TrialResult>> trials_by_place(const study::Study& study,
                                                                  const TrialSample& sample) {
  constexpr std::size_t max_of_place = 4;
  const std::size_t each = std::max<std::size_t>(sample.trials.size() / sampled_places, 1);
  const std::size_t size = std::min<std::size_t>(each, static_cast<std::size_t>(study.trials));
  std::vector<std::span<const shards::TrialResult>> all;
  for (std::size_t place = 0; place + each <= sample.trials.size(); place += each) {
    for (std::size_t i = 0; i < std::min(each / size, max_of_place); ++i)
      all.push_back(std::span(sample.trials).subspan(place + i * size, size));
  }
  return all;
}

/// Estimated bytes of the statistics and the labels of the design points, from the statistics of some points.
double bytes_of_points(const study::Study& study, const TrialSample& sample) {
  constexpr double bytes_of_text = 32.0;  // its reference and its place in the heap, without its letters
  double bytes = 0.0;
  for (const std::string& label : study.points.labels)
    bytes += bytes_of_text + static_cast<double>(label.size());
  std::vector<measures::PointSummary> points;
  for (const std::span<const shards::TrialResult> trials : trials_by_place(study, sample)) {
    summary::SummedPoint point(study, 0, 0);
    point.add(trials);
    points.push_back(point.statistics(statistics::summary_confidence, false));
  }
  const auto count = static_cast<double>(study::point_count(study));
  for (const layout::PointColumn& column :
       measures::point_columns(points, study.features, layout::measure_table(study.features)))
    bytes += stored_bytes({hdf5::Element::float64, std::as_bytes(std::span(column.values)), 1.0}, count);
  return bytes + 8.0 * count * static_cast<double>(study.points.axes.size());
}

/// Number of datasets in the results file.
double datasets_of(const study::Study& study) {
  const layout::MeasureTable& measures = layout::measure_table(study.features);
  std::size_t datasets = 12 + study.points.axes.size() + 2 * study.profiles.size() +
                         measures::statistic_fields(study.features, measures).size();
  if (study.open_loop) datasets += measures::level_fields(measures).size();
  if (layout::has_trials(study.retention)) {
    for (const shards::ShardTable& table : shards::shard_tables(study, measures))
      datasets += table.table.columns.size();
  }
  constexpr std::size_t of_repeatability = 286, of_sums = 7, of_groups = 6;
  if (!study.sequence.empty()) datasets += of_repeatability;
  if (layout::has_sums(study.retention)) datasets += of_sums;
  for (const study::GroupingTraits& of : study::groupings)
    if (study::group_count(study, of.grouping) > 0)
      datasets += study.columns.shared[of.grouping].size() + of_groups;
  return static_cast<double>(datasets);
}

/// Size of the sums of a design point (which replace the trials if not all are kept), bytes: `raw` as 8-byte
/// numbers, `stored` as the file stores them.
struct SumsSize {
  double raw;
  double stored;
};

SumsSize size_of_sums(const study::Study& study, std::span<const shards::TrialResult> trials) {
  summary::SummedPoint point(study, 0, 0);
  point.add(trials);
  const layout::PointSums sums = point.sums();
  return {8.0 * static_cast<double>(sums.whole.size() + sums.real.size()),
          stored_bytes(hdf5::Element::int64, std::as_bytes(std::span(sums.whole))) + stored_reals(sums.real)};
}

/// Estimated bytes of the sums of all design points. The sums of growing numbers of trials of one point are
/// extrapolated to all trials of a point. Each doubling of the trials adds values, as long as there are
/// further machines.
double bytes_of_sums(const study::Study& study, const TrialSample& sample) {
  const std::span<const shards::TrialResult> trials(sample.of_point);
  if (trials.empty()) return 0.0;
  const SumsSize all = size_of_sums(study, trials);
  double bytes = all.stored;
  const auto tried = static_cast<double>(trials.size());
  const auto wanted = static_cast<double>(study.trials);
  if (trials.size() >= 4 && wanted > tried) {
    const SumsSize half = size_of_sums(study, trials.first(trials.size() / 2));
    const SumsSize quarter = size_of_sums(study, trials.first(trials.size() / 4));
    const double growth = std::clamp((all.raw - half.raw) / std::max(half.raw - quarter.raw, 1.0), 1.0, 2.0);
    const double ratio = (all.stored - quarter.stored) / std::max(all.raw - quarter.raw, 1.0);
    const double different =
        study.machines > 0 ? std::clamp(static_cast<double>(study.machines), tried, wanted) : wanted;
    double added = all.raw - half.raw;
    for (double doublings = std::log2(different / tried); doublings > 0.0; --doublings) {
      added *= growth;
      bytes += ratio * added * std::min(doublings, 1.0);
    }
    constexpr double bytes_of_move = 20.0;  // of a machine that has others; measured
    bytes += bytes_of_move * (wanted - different) * static_cast<double>(study.moves);
  }
  return bytes * static_cast<double>(study::point_count(study));
}

}  // namespace

double file_bytes(const study::Study& study, const TrialSample& sample) {
  return bytes_of_dataset * datasets_of(study) + static_cast<double>(study.manifest.text.size()) +
         bytes_of_trials(study, sample) + bytes_of_records(study, sample) + bytes_of_profiles(study) +
         bytes_of_machines(study) + bytes_of_points(study, sample) + bytes_of_sums(study, sample);
}

}  // namespace zerocount::forecast

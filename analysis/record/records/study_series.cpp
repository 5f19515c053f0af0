#include <cmath>

#include <fmt/format.h>

#include "analysis/record/records/raw_series.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/roots.hpp"
#include "core/trial/open_loop.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::records {
namespace {

/// Index of the first sample of global row `row` in the trace, which is ordered by trial; the size of the
/// trace if there is none.
std::int64_t first_record(const reading::AllTrialsFile& file, std::int64_t row) {
  return numerics::first_where(0, file.trace_count(),
                               [&](std::int64_t at) { return file.trace_at(at, 1).front().trial >= row; });
}

std::vector<layout::TraceRecord> records_of(const reading::AllTrialsFile& file, std::int64_t row) {
  const std::int64_t first = first_record(file, row);
  return file.trace_at(first, first_record(file, row + 1) - first);
}

motion::PlantStart start_of(const trial::TrialParameters& trial, const SeriesChoice& choice) {
  motion::PlantStart start;
  start.hardening = choice.hardening.value_or(trial.initial.hardening);
  start.preload = choice.preload.value_or(trial.initial.preload);
  start.history = trial::draw_history(trial.initial.history, trial.randomness);
  start.velocity = trial.initial.velocity;
  return start;
}

/// The random or varied input values of one trial that belong to the plant or the friction, in the order of
/// the study's inputs.
std::vector<double> axis_inputs(const study::Study& study, std::int64_t point, std::int64_t index) {
  const std::vector<double> inputs = study::study_trial(study, point, index).inputs;
  std::vector<double> own;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string& name = study.columns.inputs[i].name;
    if (name.starts_with("plant.") || name.starts_with("friction.")) own.push_back(inputs[i]);
  }
  return own;
}

}  // namespace

TracedPoints traced_points(const std::filesystem::path& path, std::int64_t index) {
  const reading::AllTrialsFile file(path, reading::Require::any_part);
  const study::Study& study = file.study();
  TracedPoints traced;
  std::vector<double> of_first;
  if (index >= study.trials) return {{0}, {}};
  for (std::int64_t point = 0; point < study::point_count(study); ++point) {
    const std::int64_t row = point * study.trials + index;
    if (first_record(file, row) == first_record(file, row + 1)) continue;
    const std::vector<double> own = axis_inputs(study, point, index);
    if (traced.points.empty()) of_first = own;
    if (own == of_first) {
      traced.points.push_back(point);
    } else {
      traced.left_out.push_back(
          fmt::format("point {} ({})", point, study.points.labels[static_cast<std::size_t>(point)]));
    }
  }
  if (traced.points.empty()) traced.points.push_back(0);  // read_study_series() names what is missing
  return traced;
}

RawSeries read_study_series(const std::filesystem::path& path, std::int64_t point, std::int64_t index,
                            const SeriesChoice& choice) {
  const reading::AllTrialsFile file(path, reading::Require::any_part);
  const study::Study& study = file.study();
  if (point >= study::point_count(study) || index >= study.trials) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: has no point {}, trial {}; it has {} points of {} trials", path.string(),
                              point, index, study::point_count(study), study.trials));
  }
  const std::vector<layout::TraceRecord> records = records_of(file, point * study.trials + index);
  if (records.empty()) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: keeps no records of point {}, trial {}; a study keeps those that its "
                              "manifest names: retain: {{trials: [{}]}}",
                              path.string(), point, index, index));
  }
  const trial::TrialParameters trial = study::study_trial(study, point, index).parameters;

  RawSeries series;
  series.name = fmt::format("{} (point {}, trial {})", path.string(), point, index);
  series.linear = study.units.axis == parameters::AxisKind::linear;
  const bool counts = choice.angle.value_or("count") == "count";
  // Without a drive_torque column, the motor torque equals the commanded torque after the control delay.
  const bool commanded = choice.torque.value_or("drive_torque") == "torque" || !file.features().drive_torque;
  const double delay = trial.controller.delay;
  if (!commanded && delay != std::floor(delay)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its delay of {} samples ends within a sample, and drive_torque is the motor's "
                    "torque at the samples alone; expected --torque torque",
                    path.string(), delay));
  }
  for (const layout::TraceRecord& record : records) {
    series.time.push_back(record.t);
    series.torque.push_back(commanded ? record.torque : record.drive_torque);
    series.angle.push_back(counts ? static_cast<double>(record.count) : record.theta);
    series.code.push_back(static_cast<double>(record.code));
    series.sliding.push_back(record.mode == trial::HookMode::slide);
  }
  series.torque_kind = commanded ? TorqueKind::commanded : TorqueKind::motor;
  series.bandwidth = choice.bandwidth.value_or(trial.amplifier.bandwidth);
  series.delay = delay_of(series, choice, trial.controller.delay);
  if (counts) series.count_size = choice.count_size.value_or(trial.encoder.fine_length / trial.encoder.fine);
  series.dac_bits = choice.dac_bits.value_or(trial.dac.bits);
  series.start = start_of(trial, choice);
  series.units_known = true;
  return series;
}

}  // namespace zerocount::records

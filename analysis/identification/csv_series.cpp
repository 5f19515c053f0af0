#include <algorithm>

#include <fmt/format.h>

#include "analysis/identification/csv_table.hpp"
#include "analysis/identification/raw_series.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::identification {
namespace {

/// The first column of `known` that the table has, or the chosen one.
std::string column_of(const CsvTable& table, const std::optional<std::string>& chosen,
                      const std::vector<std::string>& known, const std::string& what) {
  if (chosen) {
    if (table.has(*chosen)) return *chosen;
    throw Failure(ExitCode::bad_input, fmt::format("{}: has no column '{}'; its columns are {}", table.name(),
                                                   *chosen, table.columns_text()));
  }
  for (const std::string& name : known) {
    if (table.has(name)) return name;
  }
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: has no column for the {}; expected {}; its columns are {}", table.name(),
                            what, fmt::join(known, " or "), table.columns_text()));
}

std::vector<double> read_numbers(const CsvTable& table, const std::string& column,
                                 const std::vector<std::string>& units) {
  const std::string& unit = table.unit(column);
  if (!unit.empty() && std::find(units.begin(), units.end(), unit) == units.end()) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: column '{}' is in '{}'; expected {}", table.name(),
                                                   column, unit, units.front()));
  }
  return table.numbers(column);
}

}  // namespace

std::string place_of(const RawSeries& series, std::size_t sample) {
  if (series.lines.empty()) return fmt::format("{}, sample {}", series.name, sample);
  return fmt::format("{}:{}", series.name, series.lines[sample]);
}

double delay_of(const RawSeries& series, const SeriesChoice& choice, double otherwise) {
  if (series.torque_kind == TorqueKind::commanded) return choice.delay.value_or(otherwise);
  if (choice.delay.value_or(0.0) == 0.0) return 0.0;
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: drive_torque is the motor's torque, behind any delay; --delay goes with "
                            "--torque torque",
                            series.name));
}

RawSeries read_csv_series(const std::filesystem::path& path, const SeriesChoice& choice) {
  const CsvTable table(path);
  const std::string time = column_of(table, std::nullopt, {"t", "time"}, "time");
  if (table.has("t") && table.has("time")) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: has both columns t and time; expected one of them", table.name()));
  }
  const std::string torque = column_of(table, choice.torque, {"drive_torque", "torque"}, "torque");
  std::vector<std::string> angles{"theta", "count"};
  if (choice.counts_per_revolution) std::swap(angles[0], angles[1]);
  const std::string angle = column_of(table, choice.angle, angles, "angle");
  if (angle == "count" && !choice.counts_per_revolution) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: the angle is in counts; --counts-per-revolution is missing", table.name()));
  }

  RawSeries series;
  series.name = table.name();
  for (std::size_t row = 0; row < table.rows(); ++row) series.lines.push_back(table.line(row));
  series.time = read_numbers(table, time, {"s"});
  series.torque = read_numbers(table, torque, {"N m", "Nm", "N·m"});
  series.torque_kind = torque == "drive_torque" ? TorqueKind::motor : TorqueKind::commanded;
  series.bandwidth = choice.bandwidth.value_or(0.0);
  series.delay = delay_of(series, choice, 0.0);
  const bool counts = angle == "count";
  series.angle = read_numbers(
      table, angle, counts ? std::vector<std::string>{"count", "1"} : std::vector<std::string>{"rad"});
  if (counts) series.counts_per_revolution = *choice.counts_per_revolution;
  if (table.has("code")) series.code = table.numbers("code");
  series.dac_bits = choice.dac_bits.value_or(0);
  if (table.has("mode")) series.sliding = table.equals("mode", "slide");
  series.start.preload = choice.preload.value_or(0.0);
  series.start.hardening = choice.hardening.value_or(0.0);
  return series;
}

}  // namespace zerocount::identification

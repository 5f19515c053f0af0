#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "results/layout/measure_table.hpp"

namespace zerocount::monitor {

/// How a change of a measure is stated.
enum class Scale {
  proportion,  ///< in [0, 1]: a quality of moves, or a fraction
  counts,      ///< whole numbers, at least 0
  plain        ///< any number
};

/// A measure of moves, by the row of the table of measures that a column is named after.
struct MonitoredMeasure {
  std::string name;  ///< that of the column: "band_settling_time[1]"
  std::string unit;  ///< as the table has it: "s"
  const layout::Measure* row{nullptr};
  bool quality{false};  ///< 1 of moves that have it, 0 of others; an outcome is whether it is zero_count
  Scale scale{Scale::plain};
  /// A state of the simulated friction, which grows from move to move: it is watched only where it is named.
  bool accumulates{false};
};

/// The measure of that name, with any error band or tolerance in brackets; nothing if there is none. Its own
/// name has the number as the program writes it: that of "band_settling_time[1.0]" has [1].
std::optional<MonitoredMeasure> measure_named(std::string_view name);

/// The name in the head of a column without its unit, and the unit: "band_settling_time[1] [ms]".
struct ColumnHead {
  std::string name;
  std::string unit;  ///< empty without one
};
ColumnHead column_head(std::string_view text);

/// Factor from the unit of a column to SI, as far as the program knows units; 1 without one.
double si_factor(std::string_view unit);
/// Whether numbers of one unit can be compared with those of the other, both in SI. Without a unit: yes.
bool have_same_dimension(std::string_view one, std::string_view other);

/// The unit of the measure on a linear axis.
std::string linear_unit(const MonitoredMeasure& measure);

/// Whether a column of the measure can have this unit, on an axis of any kind. What is counted has no
/// multiples of its unit, such as percent. Without a unit: yes.
bool can_be_in(const MonitoredMeasure& measure, std::string_view unit);

/// The value that is ranked, of the number that a results file or a log has. NaN, which stands for what never
/// happened, becomes larger than any number.
double ranked_value(const MonitoredMeasure& measure, double number);

/// The rank correlation of successive values, 1 − V/2 with the rank version of von Neumann's ratio
/// V = Σ(r_t − r_{t+1})²/Σ(r_t − r̄)² (Bartels, J. Amer. Statist. Assoc. 77 (1982) 40); 0 where all are equal.
/// For n independent values it has about the standard deviation 1/√n.
double serial_correlation(std::span<const double> values);

/// The value of a block of consecutive moves: the median, or of a quality the proportion that have it.
double block_value(const MonitoredMeasure& measure, std::span<const double> moves);

}  // namespace zerocount::monitor

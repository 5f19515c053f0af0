#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study.hpp"
#include "results/hdf5/element.hpp"

/// The layout of results files: the one description from which the writer, the reader, the CSV export and the
/// test of the format's documentation (README.md of this folder) all derive.
namespace zerocount {

/// Version of the layout. A file with a higher number was written by a later program, and is refused.
inline constexpr std::int64_t format_version = 1;

/// One value of an enumeration, and its word in `flag_meanings` and in CSV.
struct FlagMeaning {
  std::int64_t value{0};
  std::string word;
};

/// The outcomes of a move.
std::vector<FlagMeaning> outcome_words();

/// One dataset of a table.
struct Column {
  std::string name;       ///< path below the table's group
  std::string unit;       ///< "1" where dimensionless
  std::string long_name;  ///< one line
  Element element{Element::float64};
  std::vector<FlagMeaning> flags;  ///< of an enumeration, otherwise empty
  std::string role;                ///< in /point only: "axis" or "statistic"
};

/// The word of `value` in an enumeration; the number itself where it has none.
std::string word_of(const Column& column, std::int64_t value);

/// A group of columns that share their first dimension, and the dimension scales that stand in it.
struct Table {
  std::string group;             ///< path from the root
  Column rows;                   ///< dimension scale of the first dimension
  std::optional<Column> second;  ///< dimension scale of the second dimension, of all columns
  std::vector<Column> columns;
};

/// Where a column's value stands in a record.
template <class Record>
using Member = std::variant<double Record::*, std::int64_t Record::*, int Record::*, bool Record::*,
                            Outcome Record::*, HookMode Record::*>;

template <class Record>
struct RecordField {
  Column column;
  Member<Record> member;
};

/// A jerk, and the trial it belongs to.
struct JerkRecord : Jerk {
  std::int64_t trial{0};  ///< global row
};

/// A sampling instant of a retained trial.
struct TraceRecord : SampleRecord {
  std::int64_t trial{0};  ///< global row
};

const std::vector<RecordField<MoveOutcome>>& outcome_fields();
const std::vector<RecordField<JerkRecord>>& jerk_fields();
const std::vector<RecordField<TraceRecord>>& trace_fields();

/// One number per design point, made when a study is complete.
struct PointColumn {
  std::string name;
  std::string unit;
  std::string long_name;
  std::vector<double> values;  ///< [point]; NaN where there is none
};

/// Number of angles at which a profile is tabulated, over one revolution.
inline constexpr std::int64_t profile_angles = 4096;

Table point_table(const std::vector<SweepAxis>& axes, const std::vector<PointColumn>& statistics);
Table trial_table(const std::vector<InputColumn>& inputs);
Table outcome_table();
Table jerk_table();
Table trace_table();
Table profile_table(const std::string& name, const std::string& unit);

/// Name in /trial of the column of an input parameter.
std::string input_column_name(const std::string& parameter);

}  // namespace zerocount

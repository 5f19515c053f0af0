#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <zerocount/zerocount.h>

#include "experiments/study/study.hpp"
#include "results/layout/fields.hpp"

namespace zerocount::library {

/// Named arrays that a job of the library returns.
class Result {
 public:
  /// Adds the fields of the records as columns (arrays), one row per record.
  /// @param prefix prefix of the column names
  template <class Record>
  void add(const std::string& prefix, const std::vector<layout::RecordField<Record>>& fields,
           std::span<const Record* const> records) {
    std::vector<std::vector<std::byte>> columns = layout::columns_of(fields, records);
    for (std::size_t i = 0; i < fields.size(); ++i)
      add(prefix + fields[i].column.name, fields[i].column.element, std::move(columns[i]));
  }
  void add(std::string name, hdf5::Element element, std::vector<std::byte> values);

  std::vector<zerocount_array> arrays() const;  ///< Views of the arrays, which this object owns.

 private:
  struct Column {
    std::string name;
    hdf5::Element element{};
    std::vector<std::byte> values;
  };
  std::vector<Column> columns_;
};

/// Simulates trials with given values of the random variables. Returns the measures of their moves.
/// @param point index of the design point
/// @param values [trial][variable] values of the variables
/// @param numbers [trial] number from which the trial's other random numbers follow
/// @param threads number of threads
Result simulated(const study::Study& study, std::int64_t point, std::span<const double> values,
                 std::span<const std::int64_t> numbers, int threads, const std::stop_token& stop);

/// Simulates a trial of a design point and returns its samples.
/// @param point index of the design point
/// @param trial number of the trial
/// @param law control law that replaces the law of the manifest; null: the law of the manifest
Result traced(const study::Study& study, std::int64_t point, std::int64_t trial, zerocount_law* law,
              const std::stop_token& stop);

}  // namespace zerocount::library

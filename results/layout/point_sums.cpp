#include "results/layout/point_sums.hpp"

#include <fmt/format.h>

#include "core/hash/sha256.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::layout {
namespace {

/// Grows with every change of the fields that stand in files, or of their order.
constexpr int form_number = 2;

std::string text_of(const ReportedStatistics& reported) {
  std::string text;
  for (const StatisticText& reported_text : reported.texts) {
    for (const Statistic statistic : reported_text.statistics)
      text += fmt::format(" {}", static_cast<int>(statistic));
  }
  return text;
}

/// Writes the numbers of all points, one after the other, and in the column `counts` how many each has.
template <class Number>
void write_numbers(hdf5::File& file, const Table& table, std::span<const PointSums> sums,
                   std::vector<Number> PointSums::*numbers, hdf5::Dataset& counts) {
  std::vector<Number> all;
  std::vector<std::int64_t> sizes;
  for (const PointSums& point : sums) {
    all.insert(all.end(), (point.*numbers).begin(), (point.*numbers).end());
    sizes.push_back(std::ssize(point.*numbers));
  }
  counts.write(0, std::ssize(sizes), sizes.data());
  TableIo io = TableIo::create(file, table, std::ssize(all), 1);
  io.number_rows(0);
  io.column(0).write(0, std::ssize(all), all.data());
}

}  // namespace

void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const PointSums> sums) {
  TableIo io = TableIo::create(file, sums_table(), std::ssize(sums), 1);
  io.number_rows(first_point);
  write_numbers(file, whole_sums_table(), sums, &PointSums::whole, io.column(0));
  write_numbers(file, real_sums_table(), sums, &PointSums::real, io.column(1));
}

std::string sums_form() {
  std::string text = fmt::format("{}\n", form_number);
  for (const Measure& measure : measure_table())
    text +=
        fmt::format("{}:{};{}\n", measure.field.column.name, text_of(measure.point), text_of(measure.level));
  return fmt::format("{}-{}", form_number, hash::sha256_hex(text).substr(0, 16));
}

}  // namespace zerocount::layout

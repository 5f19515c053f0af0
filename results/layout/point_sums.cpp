#include "results/layout/point_sums.hpp"

#include <fmt/format.h>

#include "core/hash/sha256.hpp"
#include "results/layout/measure_table.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount::layout {
namespace {

/// Version of the sums over trials in /sums. It is raised with every change of the numbers or of their order.
constexpr int form_number = 2;

std::string text_of(const ReportedStatistics& reported) {
  std::string text;
  for (const StatisticText& reported_text : reported.texts) {
    for (const Statistic statistic : reported_text.statistics)
      text += fmt::format(" {}", static_cast<int>(statistic));
  }
  return text;
}

template <class Number>
void write_numbers(hdf5::File& file, const Table& table, const std::vector<Number>& numbers) {
  TableIo io = TableIo::create(file, table, std::ssize(numbers), 1);
  io.number_rows(0);
  io.column(0).write(0, std::ssize(numbers), numbers.data());
}

}  // namespace

SumColumns::SumColumns(std::span<const PointSums> sums) {
  for (const PointSums& point : sums) {
    whole_counts.push_back(std::ssize(point.whole));
    real_counts.push_back(std::ssize(point.real));
    whole.insert(whole.end(), point.whole.begin(), point.whole.end());
    real.insert(real.end(), point.real.begin(), point.real.end());
  }
}

void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const PointSums> sums) {
  const SumColumns columns(sums);
  TableIo io = TableIo::create(file, sums_table(), std::ssize(sums), 1);
  io.number_rows(first_point);
  io.column(0).write(0, io.rows(), columns.whole_counts.data());
  io.column(1).write(0, io.rows(), columns.real_counts.data());
  write_numbers(file, whole_sums_table(), columns.whole);
  write_numbers(file, real_sums_table(), columns.real);
}

std::string sums_form() {
  std::string text = fmt::format("{}\n", form_number);
  for (const Measure& measure : measure_table())
    text +=
        fmt::format("{}:{};{}\n", measure.field.column.name, text_of(measure.point), text_of(measure.level));
  return fmt::format("{}-{}", form_number, hash::sha256_hex(text).substr(0, 16));
}

}  // namespace zerocount::layout

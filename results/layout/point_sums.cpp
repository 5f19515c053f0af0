#include "results/layout/point_sums.hpp"

#include <fmt/format.h>

#include "core/hash/sha256.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::layout {
namespace {

/// Grows with every change of the fields that stand in files, or of their order.
constexpr int form_number = 1;

std::string text_of(const ReportedStatistics& reported) {
  std::string text;
  for (const StatisticText& reported_text : reported.texts) {
    for (const Statistic statistic : reported_text.statistics)
      text += fmt::format(" {}", static_cast<int>(statistic));
  }
  return text;
}

}  // namespace

std::string sums_form() {
  std::string text = fmt::format("{}\n", form_number);
  for (const Measure& measure : measure_table())
    text +=
        fmt::format("{}:{};{}\n", measure.field.column.name, text_of(measure.point), text_of(measure.level));
  return fmt::format("{}-{}", form_number, hash::sha256_hex(text).substr(0, 16));
}

}  // namespace zerocount::layout

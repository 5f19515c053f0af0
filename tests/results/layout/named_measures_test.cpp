// The measures that a goal can limit are those of the file.
#include "core/trial/named_measures.hpp"

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "results/layout/layout.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::testing {
namespace {

TEST(NamedMeasures, AreColumnsOfTheFile) {
  const study::StudyFeatures features{.bands = {{3}, 1}, .tolerances = {{1e-8}, 1}};
  const layout::MeasureTable& measures = layout::measure_table(features);
  const auto expect_column = [&](std::string_view name) {
    EXPECT_TRUE(std::ranges::any_of(measures, [name](const layout::Measure& measure) {
      return measure.field.column.name == name;
    })) << name;
  };
  for (const trial::NamedMeasure& named : trial::named_measures()) expect_column(named.name);
  for (const std::string_view named : trial::named_band_measures())
    expect_column(layout::name_of_band(named, 3));
  expect_column(layout::name_of_tolerance(trial::tolerance_measure, 1e-8));
}

}  // namespace
}  // namespace zerocount::testing

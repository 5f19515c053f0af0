// The measures that a goal can limit are those of the file, by name and by value.
#include "core/trial/named_measures.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"
#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

TEST(NamedMeasures, AreColumnsOfTheFileWithTheSameValues) {
  const study::Study study = sample_study();
  const std::vector<shards::TrialResult> results = sample_results(study, layout::all_rows(study));
  for (const trial::NamedMeasure& named : trial::named_measures()) {
    const layout::Measure* column = nullptr;
    for (const layout::Measure& measure : layout::measure_table())
      if (measure.field.column.name == named.name) column = &measure;
    ASSERT_NE(column, nullptr) << named.name;
    for (const shards::TrialResult& result : results) {
      for (const trial::MoveOutcome& move : result.outcome.moves) {
        const double value = named.value(move);
        const double stored = layout::value_of(column->field, move);
        EXPECT_TRUE(value == stored || (std::isnan(value) && std::isnan(stored))) << named.name;
      }
    }
  }
}

}  // namespace
}  // namespace zerocount::testing

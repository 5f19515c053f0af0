#include "experiments/study/input_ranges.hpp"

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::study {

bool contains(const InputRange& allowed, double value) {
  return numerics::contains(allowed.range, value) || (allowed.none && value == *allowed.none);
}

std::vector<InputRange> input_ranges(const Study& study) {
  std::vector<InputRange> ranges;
  if (study.plan == nullptr) return ranges;
  for (const InputSource& source : study.plan->inputs) {
    const parameters::Parameter& row = study.plan->table.rows[source.slot];
    ranges.push_back({parameters::range_of(row, study.units), row.none});
  }
  return ranges;
}

}  // namespace zerocount::study

#include "tests/fuzz/study_use.hpp"

#include <set>
#include <string>

#include "experiments/manifest/parameter_listing.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/fuzz/expectation.hpp"

namespace zerocount::fuzz {
namespace {

/// The indices of the first and the last of `count` items.
std::set<std::int64_t> ends_of(std::int64_t count) {
  return {0, count - 1};
}

}  // namespace

void use_study(const study::Study& study) {
  for (const std::string& warning : study.warnings) require_text(warning);
  for (const study::InputColumn& column : study.columns.inputs) require_text(column.name);
  for (const manifest::ListedParameter& row : manifest::listed_parameters(study)) require_text(row.name);
  for (const std::int64_t point : ends_of(study::point_count(study))) {
    require_text(study.points.labels[static_cast<std::size_t>(point)]);
    for (const std::int64_t index : ends_of(study.trials)) study::study_trial(study, point, index);
  }
  if (study.machines == 0) return;
  for (const std::int64_t machine : ends_of(study.machines))
    study::group_inputs(study, study::Grouping::machine, machine);
}

}  // namespace zerocount::fuzz

#include "analysis/law_identification/law_fragment.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "analysis/text/text.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {

using identification::EstimateStatus;
using identification::ParameterEstimate;

std::string law_fragment(Records records, const LawModel& model, const LawPoint& point,
                         const IdentifiedLaw& law) {
  std::string text = "# Identified from";
  for (const TestRecord& record : records) {
    text += fmt::format("{} {}", &record == &records.front() ? "" : ",", text::printable(record.name));
  }
  text += ".\n# The central 95 % of each distribution are the confidence interval.\n";
  for (const ParameterEstimate& parameter : law.parameters) {
    if (parameter.name != "series_compliance" || parameter.status != EstimateStatus::estimated) continue;
    text += fmt::format("# A fixture gives way by {} {}; a manifest has none.\n",
                        identification::with_digits(parameter.value, parameter), parameter.unit);
  }
  if (!law.checks.passed) {
    text += "# Lack of fit: encoder and noise do not explain the residuals; do not rely on these values.\n";
  }
  if (records.front().axis == parameters::AxisKind::linear) text += "axis: linear\n";
  for (const std::string group : {"plant", "friction"}) {
    std::string lines = group == "plant" ? model.plant_lines
                                         : fmt::format("  model: {}\n", friction::traits_of(law.law).word);
    for (const ParameterEstimate& parameter : law.parameters) {
      if (!parameter.key.starts_with(group + ".")) continue;
      lines += identification::manifest_line(parameter, parameter.key.substr(group.size() + 1));
    }
    if (group == "friction") lines += parameters::unit_on(records.front().axis, model.fixed_lines(point));
    // A map that contains only comments would not be a map.
    const bool any =
        group == "friction" || !model.plant_lines.empty() ||
        std::any_of(law.parameters.begin(), law.parameters.end(), [&](const auto& parameter) {
          return parameter.key.starts_with(group + ".") && parameter.status == EstimateStatus::estimated;
        });
    text += fmt::format("{}{}:\n{}", any ? "" : "# ", group, lines);
  }
  return text;
}

}  // namespace zerocount::law_identification

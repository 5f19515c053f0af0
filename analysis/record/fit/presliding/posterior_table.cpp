#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "core/text/text.hpp"

namespace zerocount::fit {
namespace {

std::string units_line(const Identification& identification) {
  std::vector<std::string> units;
  for (const ParameterEstimate& parameter : identification.parameters) {
    if (std::count(identification.draws.keys.begin(), identification.draws.keys.end(), parameter.key) == 0)
      continue;
    units.push_back(fmt::format("{} in {}", parameter.key, parameter.unit));
  }
  return fmt::format("# Units: {}\n", fmt::join(units, ", "));
}

/// Comment lines that name the parameters without a column in the table of joint draws, each with the reason.
std::string left_out_lines(const Identification& identification) {
  std::string lines;
  for (const ParameterEstimate& parameter : identification.parameters) {
    if (parameter.key.empty() || parameter.status == EstimateStatus::estimated) continue;
    lines += parameter.status == EstimateStatus::not_identifiable
                 ? fmt::format("# Not drawn: {}, which is not identifiable\n", parameter.key)
                 : fmt::format("# Not drawn: {}, which is given as {}\n", parameter.key, parameter.value);
  }
  return lines;
}

}  // namespace

std::string posterior_table(const Identification& identification) {
  std::vector<std::string> names;
  for (const RecordSummary& record : identification.records) names.push_back(text::printable(record.name));
  std::string text = fmt::format(
      "# Joint draws of the parameters of one contact, identified from {}\n"
      "# Every row is one draw: the estimate less the error of one replicate of a parametric bootstrap, so\n"
      "# that errors which correlate stay together. For the key samples of a manifest.\n",
      fmt::join(names, ", "));
  text += units_line(identification) + left_out_lines(identification);
  text += lack_of_fit_comment(identification.checks.passed);
  text += fmt::format("{}\n", fmt::join(identification.draws.keys, ","));
  for (const std::vector<double>& row : identification.draws.rows) {
    for (std::size_t j = 0; j < row.size(); ++j) text += fmt::format("{}{:.12g}", j > 0 ? "," : "", row[j]);
    text += "\n";
  }
  return text;
}

}  // namespace zerocount::fit

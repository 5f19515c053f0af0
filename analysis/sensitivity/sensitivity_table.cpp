#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::sensitivity {
namespace {

std::string with_bounds(const BoundedNumber& number) {
  if (std::isnan(number.value)) return "–";
  if (std::isnan(number.low)) return fmt::format("{:.3f}", number.value);
  return fmt::format("{:.3f} [{}, {}]", number.value, text::rounded_down(number.low, 3),
                     text::rounded_up(number.high, 3));
}

bool has_some(const OutputSensitivity& output, const FactorNumber& one) {
  return std::any_of(output.factors.begin(), output.factors.end(), [&](const FactorSensitivity& factor) {
    return !std::isnan((factor.*one.number).value);
  });
}

std::string factor_table(const OutputSensitivity& output, bool from_saltelli) {
  std::vector<text::TextColumn> columns{{"factor", false, {}}, {"matters", false, {}}};
  for (const FactorSensitivity& factor : output.factors) {
    columns[0].cells.push_back(text::printable(factor.name));
    columns[1].cells.emplace_back(factor.matters ? "yes" : "");
  }
  for (const FactorNumber& measure : factor_numbers) {
    if (!has_some(output, measure)) continue;
    const bool alone = measure.number == &FactorSensitivity::first_order && !from_saltelli;
    text::TextColumn column{alone ? "alone" : measure.head, false, {}};
    for (const FactorSensitivity& factor : output.factors) {
      column.cells.push_back(with_bounds(factor.*measure.number));
    }
    columns.push_back(std::move(column));
  }
  return text::aligned_table(columns);
}

std::string left_out_line(const OutputSensitivity& output) {
  std::string names;
  for (const FactorLeftOut& factor : output.left_out) {
    names += fmt::format("{}{}: {}", names.empty() ? "" : "; ", text::printable(factor.name), factor.reason);
  }
  return names.empty() ? "" : fmt::format("  left out: {}\n", names);
}

std::string output_text(const OutputSensitivity& output, bool from_saltelli) {
  std::string text = fmt::format("{}{}: {}\n", output.output,
                                 output.unit == "1" ? "" : fmt::format(" ({})", output.unit), output.meaning);
  text += fmt::format("  {} {}, mean {}, standard deviation {}\n", output.trials,
                      output.of_worlds ? "worlds" : "trials", text::short_number(output.mean),
                      text::short_number(output.standard_deviation));
  text += fmt::format("  {}\n", output.conclusion);
  for (const std::string& note : output.notes) text += fmt::format("  note: {}\n", note);
  text += left_out_line(output);
  if (output.estimated) text += fmt::format("\n{}", factor_table(output, from_saltelli));
  return text + "\n";
}

std::string legend(const StudySensitivity& sensitivity) {
  const std::string bounds =
      fmt::format("[,]: {} confidence bounds, each by itself. matters: those of {}.\n",
                  text::percent(sensitivity.confidence),
                  sensitivity.from_saltelli
                      ? fmt::format("total are above {:g}", relevant_index)
                      : fmt::format("alone are above {:g}, or those of partial rank corr. beyond ±{:g}",
                                    relevant_index, relevant_correlation));
  const std::string proportions =
      sensitivity.from_saltelli
          ? "total, first order: proportions of the variance (Sobol' indices) in which the factor has a "
            "part, and "
            "that\n"
            "it explains alone. A part that several factors share counts in the total of each: totals need "
            "not\nadd up to 1.\n"
          : "alone: proportion of the variance that the factor explains alone (first-order Sobol' index); "
            "what it "
            "does\n"
            "only together with others does not show here, but does with design: saltelli.\n";
  return bounds + proportions +
         "rank corr.: whether the output rises (+) or falls (-) with the factor; partial rank corr.: with "
         "the part\n"
         "of the other factors taken out. log odds per sd: what a standard deviation of the factor adds to\n"
         "ln(p/(1 - p)), p the proportion of yes.\n";
}

}  // namespace

std::string sensitivity_table(const StudySensitivity& sensitivity) {
  std::string text = text::printable(sensitivity.name) + "\n\n";
  for (const PointSensitivity& point : sensitivity.points) {
    text += fmt::format("Point {}: {}\n\n", point.point, text::printable(point.label));
    for (const OutputSensitivity& output : point.outputs) {
      text += output_text(output, sensitivity.from_saltelli);
    }
  }
  return text + legend(sensitivity);
}

}  // namespace zerocount::sensitivity

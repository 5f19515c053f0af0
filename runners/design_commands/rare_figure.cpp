#include "runners/design_commands/rare_figure.hpp"

#include <cstddef>

#include "analysis/report/figures/figure.hpp"

namespace zerocount::design_commands {
namespace {

using report::datum;

/// The rows of an input: its quantiles, and their places in the range of all trials, 0 to 1.
void add_ranges(document::FigureData& data, const rare::FailureInput& input) {
  const double range = input.usual.high - input.usual.low;
  const auto place = [&](double value) { return datum((value - input.usual.low) / range); };
  const auto add = [&](const char* trials, const rare::InputRange& of) {
    data.rows.push_back({input.name, trials, datum(of.low), datum(of.median), datum(of.high), input.unit,
                         place(of.low), place(of.median), place(of.high)});
  };
  add("all trials", input.usual);
  add("failures", input.failures);
}

}  // namespace

std::vector<document::Figure> rare_figures(const std::vector<rare::FailureInput>& inputs) {
  document::FigureData data{"inputs",
                            {{"parameter", "parameter", ""},
                             {"trials", "of", ""},
                             {"low", "5 %", ""},
                             {"median", "median", ""},
                             {"high", "95 %", ""},
                             {"unit", "unit", ""},
                             {"low_place", "", ""},
                             {"median_place", "", ""},
                             {"high_place", "", ""}}};
  for (const rare::FailureInput& input : inputs) {
    if (input.usual.high > input.usual.low) add_ranges(data, input);
  }
  if (data.rows.empty()) return {};
  const std::size_t rows = data.rows.size();
  document::Figure figure = report::figure_of("rare-inputs", "rare-inputs", "What failures have in common",
                                              "Medians and 5 % to 95 % of the inputs in failures and in all "
                                              "trials. 0 % and 100 % are the ends of the "
                                              "range of all trials.",
                                              {std::move(data)});
  report::set_rows(figure, rows, 16);
  return {figure};
}

}  // namespace zerocount::design_commands

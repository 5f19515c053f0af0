#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {
namespace {

constexpr std::size_t max_rows = 60;

/// As the text of a Markdown table's cell.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("|\\`*_<").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

constexpr std::array<const char*, 11> heads{"point",  "measure", "baseline", "file",    "worse by", "bounds",
                                            "margin", "detects", "p",        "verdict", "note"};

constexpr std::size_t verdict_column = 9;  ///< in `heads`

std::vector<std::string> cells_of(const ComparisonRow& row) {
  return {row.point,  row.measure, row.baseline, row.current, row.worse_by, row.bounds,
          row.margin, row.detects, row.p,        row.verdict, row.note};
}

std::string head_of(const StudyComparison& comparison) {
  std::string text;
  for (const auto& [name, value] : comparison_facts(comparison))
    text += fmt::format("{:<17} {}\n", name, value);
  return text;
}

/// Whether a test is significant whose bounds leave the direction of the change open.
bool any_contrast(const StudyComparison& comparison) {
  return std::ranges::any_of(comparison.points, [&](const PointComparison& point) {
    return std::ranges::any_of(point.measures, [&](const MeasureComparison& measure) {
      return shown_p(measure) < comparison.false_discovery_rate && measure.bounds.low < 0.0 &&
             measure.bounds.high > 0.0;
    });
  });
}

}  // namespace

std::string comparison_table(const StudyComparison& comparison) {
  std::vector<ComparisonRow> rows = comparison_rows(comparison);
  std::string omitted;
  if (rows.size() > max_rows) {
    const std::size_t all = rows.size();
    std::erase_if(rows, [](const ComparisonRow& row) { return !row.noteworthy; });
    omitted = fmt::format("({} rows that simply passed are not shown)\n", all - rows.size());
  }
  // One column names the rows, so that every part of a divided table has it.
  const auto joined = [](std::vector<std::string> row, const char* between) {
    row[1] = row[0] + between + row[1];
    row.erase(row.begin());
    return row;
  };
  std::vector<std::vector<std::string>> cells{joined({heads.begin(), heads.end()}, ", ")};
  for (const ComparisonRow& row : rows) cells.push_back(joined(cells_of(row), " "));
  const std::vector<bool> numeric{false, true, true, true, true, true, true, true, false, false};
  const std::string table = rows.empty() ? "" : text::aligned_table(cells, numeric);
  const std::string detectable = detectable_sentence(comparison);
  const std::string cautious = any_contrast(comparison)
                                   ? "A p below the false discovery rate beside bounds that hold 0: bounds "
                                     "allow for one more rig or trial that differs by as much as one can, "
                                     "p does not; more rigs bring them together.\n"
                                   : "";
  return fmt::format(
      "{}\n{}{}\nBounds: {:.6g} % each. p: of {} tests, adjusted for a false discovery rate of {:.6g} %. "
      "Detects: the smallest change for the worse that these trials find with a probability of {:.0f} "
      "%.\n{}{}{}{}\n",
      head_of(comparison), table, omitted, 100.0 * comparison.confidence, comparison.tests,
      100.0 * comparison.false_discovery_rate, 100.0 * decision_probability, cautious, detectable,
      detectable.empty() ? "" : "\n", verdict_sentence(comparison));
}

std::string comparison_markdown(const StudyComparison& comparison) {
  const std::string_view mark = comparison.verdict == GateVerdict::passed         ? "✅"
                                : comparison.verdict == GateVerdict::inconclusive ? "❓"
                                                                                  : "❌";
  std::string text =
      fmt::format("## {} {}: {}\n\n", mark, cell(text::printable(comparison.current.header.name)),
                  cell(verdict_sentence(comparison)));
  for (const auto& [name, value] : comparison_facts(comparison))
    text += fmt::format("- {}: {}\n", name, cell(value));
  std::vector<ComparisonRow> rows = comparison_rows(comparison);
  const std::size_t all = rows.size();
  std::erase_if(rows, [](const ComparisonRow& row) { return !row.noteworthy; });
  if (!rows.empty()) {
    text +=
        fmt::format("\n| {} |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | --- |\n",
                    fmt::join(heads, " | "));
  }
  for (const ComparisonRow& row : rows) {
    std::vector<std::string> cells = cells_of(row);
    std::transform(cells.begin(), cells.end(), cells.begin(), cell);
    if (fails(row.gate)) cells[verdict_column] = fmt::format("**{}**", cells[verdict_column]);
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  }
  return text + fmt::format(
                    "\n{} of {} judgements passed and are not listed. Bounds: {:.6g} % each; false discovery "
                    "rate {:.6g} %. {}\n",
                    all - rows.size(), all, 100.0 * comparison.confidence,
                    100.0 * comparison.false_discovery_rate, detectable_sentence(comparison));
}

}  // namespace zerocount::comparison

#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {
namespace {

/// As text or an attribute of XML; what XML cannot hold is replaced.
std::string xml(std::string_view text) {
  return text::escaped_markup(text::printable(text));
}

/// The contents of the case beside its name.
std::string element_of(GateVerdict verdict, const std::string& message) {
  switch (verdict) {
    case GateVerdict::regression:
    case GateVerdict::changed:
      return fmt::format("<failure type=\"{}\" message=\"{}\"/>", to_string(verdict), xml(message));
    case GateVerdict::inconclusive:
      return fmt::format("<error type=\"inconclusive\" message=\"{}\"/>", xml(message));
    case GateVerdict::passed:
      return fmt::format("<system-out>{}</system-out>", xml(message));
    case GateVerdict::not_measured:
      break;
  }
  return fmt::format("<skipped message=\"{}\"/>", xml(message));
}

std::string case_of(const std::string& suite, const std::string& name, GateVerdict verdict,
                    const std::string& message) {
  return fmt::format("    <testcase classname=\"{}\" name=\"{}\">{}</testcase>\n", xml(suite), xml(name),
                     element_of(verdict, message));
}

std::string message_of(const ComparisonRow& row) {
  const std::string note = row.note.empty() ? "" : "; " + row.note;
  return fmt::format("{}: baseline {}, file {}, worse by {} {}, margin {}, p {}{}", row.verdict, row.baseline,
                     row.current, row.worse_by, row.bounds, row.margin, row.p, note);
}

}  // namespace

std::string comparison_junit(const StudyComparison& comparison) {
  const std::string suite = comparison.current.header.name;
  VerdictCounts counts = count_verdicts(comparison);
  std::string cases;
  for (const ComparisonRow& row : comparison_rows(comparison)) {
    cases += case_of(suite, fmt::format("{}: {}", row.point, row.measure), row.gate, message_of(row));
  }
  std::int64_t tests = counts.judged() + counts.not_measured;
  // A verdict that no single case gives: unequal data, or nothing measured.
  const bool unequal = comparison.layer == ComparisonLayer::bits && !comparison.equal_to_the_bit;
  const bool silent = comparison.verdict == GateVerdict::inconclusive && counts.inconclusive == 0;
  if (comparison.layer == ComparisonLayer::bits || silent) {
    ++tests;
    counts.regressions += unequal;
    counts.inconclusive += silent;
    const GateVerdict verdict = unequal  ? GateVerdict::regression
                                : silent ? GateVerdict::inconclusive
                                         : GateVerdict::passed;
    cases += case_of(suite, "the data", verdict, verdict_sentence(comparison));
  }
  const std::string numbers = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", tests,
                                          counts.failed(), counts.inconclusive, counts.not_measured);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"zerocount compare\" {0}>\n"
      "  <testsuite name=\"{1}\" {0}>\n{2}  </testsuite>\n</testsuites>\n",
      numbers, xml(suite), cases);
}

}  // namespace zerocount::comparison

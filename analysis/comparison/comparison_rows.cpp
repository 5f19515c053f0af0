
#include <cmath>

#include <fmt/format.h>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::comparison {
namespace {

std::string interval_text(const statistics::ConfidenceInterval& bounds, std::string_view quantity,
                          std::string_view unit) {
  if (std::isnan(bounds.low)) return "–";
  return fmt::format("[{}, {}]", value_text(bounds.low, quantity, unit),
                     value_text(bounds.high, quantity, unit));
}

std::string p_text(double p) {
  if (std::isnan(p)) return "–";
  return p < 1e-4 ? "< 1e-4" : fmt::format("{:.2g}", p);
}

/// The notes that are not empty, and what would decide.
std::string remarks(std::string note, const std::string& undecided, const std::optional<double>& trials,
                    const std::string& margins) {
  const auto add = [&](const std::string& remark) { note += (note.empty() ? "" : "; ") + remark; };
  if (!undecided.empty()) add(undecided);
  if (trials) add(fmt::format("{} trials would decide", trials_text(*trials)));
  if (!margins.empty()) add(margins);
  return note;
}

/// The margins that the trials decide where they leave that of the measure open; empty where they do not.
std::string margins_remark(const MeasureComparison& measure, double max_trials) {
  if (std::isnan(measure.decided_margin)) return {};
  const auto text = [&](double value) { return value_text(value, measure.measure, measure.unit); };
  std::string remark = fmt::format("these trials decide a margin above {}", text(measure.decided_margin));
  if (!std::isnan(measure.max_trials_margin)) {
    remark += fmt::format(", {} trials one of {}", trials_text(max_trials), text(measure.max_trials_margin));
  }
  return remark;
}

/// "undecided: 12 of 300 moves in the baseline, 4 of 300 in the file" beside a proportion of stable trials;
/// empty where there are none.
std::string undecided_remark(const PointComparison& point, std::string_view quantity) {
  const measures::UndecidedMoves& before = point.baseline_undecided;
  const measures::UndecidedMoves& after = point.current_undecided;
  if (quantity != "stable_rate" || before.off_target + after.off_target == 0) return {};
  return fmt::format("undecided: {} of {} moves in the baseline, {} of {} in the file", before.off_target,
                     before.moves, after.off_target, after.moves);
}

/// "goal undecided in the baseline, missed in the file" beside the proportion of moves in the goal; empty
/// elsewhere.
std::string goal_remark(const PointComparison& point, std::string_view measure) {
  for (const GoalStatuses& goal : point.goals) {
    if (measure == name_of_goal_measure("goal_rate", goal.name))
      return fmt::format("goal {} in the baseline, {} in the file", goal::text_of(goal.baseline),
                         goal::text_of(goal.current));
  }
  return {};
}

ComparisonRow row_of(const PointComparison& point, const MeasureComparison& measure, double max_trials) {
  const auto text = [&](double value) { return value_text(value, measure.measure, measure.unit); };
  ComparisonRow row;
  row.point = text::printable(point.label);
  row.measure = measure.measure;
  row.baseline = text(measure.baseline);
  row.current = text(measure.current);
  row.worse_by = text(measure.effect);
  row.bounds = interval_text(measure.bounds, measure.measure, measure.unit);
  row.margin = (measure.changed_fails ? "± " : "") + text(measure.margin);
  row.detects = text(measure.detectable_change);
  row.p = p_text(shown_p(measure));
  row.verdict = to_string(measure.change);
  row.gate = measure.verdict;
  row.note =
      remarks(measure.note, goal_remark(point, measure.measure) + undecided_remark(point, measure.measure),
              measure.trials_to_decide, margins_remark(measure, max_trials));
  row.noteworthy = measure.verdict != GateVerdict::passed || measure.change == ChangeVerdict::better;
  return row;
}

ComparisonRow row_of(const PointComparison& point, const RequirementResult& requirement) {
  const auto text = [&](double value) { return value_text(value, requirement.quantity, requirement.unit); };
  ComparisonRow row;
  row.point = text::printable(point.label);
  row.measure = "require " + requirement.quantity;
  row.baseline = "–";
  row.current = text(requirement.value);
  row.worse_by = "–";
  const bool quantile = requirement.quantity.find('.') != std::string::npos;
  row.bounds = quantile ? fmt::format("{} within", interval_text(requirement.bounds, "_rate", "1"))
                        : interval_text(requirement.bounds, requirement.quantity, requirement.unit);
  row.margin = fmt::format("{} {}", requirement.at_least ? "≥" : "≤", text(requirement.limit));
  row.p = "–";
  row.verdict = to_string(requirement.verdict);
  row.detects = "–";
  row.gate = requirement.verdict;
  row.note = remarks("", undecided_remark(point, requirement.quantity), requirement.trials_to_decide, "");
  row.noteworthy = requirement.verdict != GateVerdict::passed;
  return row;
}

}  // namespace

std::vector<ComparisonRow> comparison_rows(const StudyComparison& comparison) {
  std::vector<ComparisonRow> rows;
  for (const PointComparison& point : comparison.points) {
    for (const MeasureComparison& measure : point.measures)
      rows.push_back(row_of(point, measure, comparison.max_trials_to_decide));
    for (const RequirementResult& requirement : point.requirements)
      rows.push_back(row_of(point, requirement));
  }
  return rows;
}

}  // namespace zerocount::comparison

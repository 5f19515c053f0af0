#include "analysis/comparison/matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::comparison {
namespace {

constexpr std::size_t max_named = 8;

std::string some_of(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), max_named);
  const std::string text =
      fmt::format("'{}'", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), "', '"));
  return names.size() > shown ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

std::map<std::string, std::int64_t> points_by_label(const reading::AllTrialsFile& file) {
  std::map<std::string, std::int64_t> points;
  const std::vector<std::string> labels = file.point_labels();
  for (std::size_t point = 0; point < labels.size(); ++point) {
    if (!points.emplace(labels[point], static_cast<std::int64_t>(point)).second) {
      throw Failure(ExitCode::bad_data, fmt::format("{}: two design points have the label '{}'",
                                                    file.path().string(), labels[point]));
    }
  }
  return points;
}

std::vector<std::string> without_partner(std::vector<std::string> names,
                                         const std::vector<std::string>& others) {
  const std::set<std::string> known(others.begin(), others.end());
  std::erase_if(names, [&](const std::string& name) { return known.contains(name); });
  return names;
}

/// @param what of the files has these names, "design points"
/// @throws Failure (bad_data) that lists the names without a partner
void require_same_names(const reading::AllTrialsFile& baseline, const std::vector<std::string>& before,
                        const reading::AllTrialsFile& current, const std::vector<std::string>& after,
                        std::string_view what) {
  std::string problem;
  if (const auto lonely = without_partner(before, after); !lonely.empty())
    problem += fmt::format("; only {} has {}", baseline.path().string(), some_of(lonely));
  if (const auto lonely = without_partner(after, before); !lonely.empty())
    problem += fmt::format("; only {} has {}", current.path().string(), some_of(lonely));
  if (!problem.empty())
    throw Failure(ExitCode::bad_data,
                  fmt::format("the files cannot be compared: not the same {}{}", what, problem));
}

/// The names of the conditions, with ages at each of them; none of a manifest without them, which is not
/// parsed for it.
std::vector<std::string> conditions_of(const reading::AllTrialsFile& file) {
  const bool any = file.root().contains("condition") || file.root().contains("age");
  return any ? file.study().conditions : std::vector<std::string>();
}

/// The trials of the file under each of these conditions.
std::vector<reading::AllTrialsFile> files_under(const reading::AllTrialsFile& file,
                                                const std::vector<std::string>& conditions) {
  std::vector<reading::AllTrialsFile> files;
  files.reserve(conditions.size());
  for (const std::string& name : conditions)
    files.push_back(file.under_condition(study::condition_named(file.study(), name)));
  return files;
}

bool has_cases(const std::vector<study::SweepAxis>& axes) {
  return std::any_of(axes.begin(), axes.end(),
                     [](const study::SweepAxis& axis) { return axis.name == "case"; });
}

/// A number so that it reads back to the same; two NaN agree, whatever their signs.
std::string exact_text(double value) {
  return std::isnan(value) ? "drawn" : fmt::format("{}", value);
}

void require_equal_axes(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                        const std::vector<MatchedPoint>& points) {
  const std::vector<study::SweepAxis> before = baseline.axes();
  const std::vector<study::SweepAxis> after = current.axes();
  if (has_cases(before) && has_cases(after)) return;
  std::set<std::string> names;
  for (const study::SweepAxis& axis : before) names.insert(axis.name);
  for (const study::SweepAxis& axis : after) names.insert(axis.name);
  for (const MatchedPoint& point : points) {
    for (const std::string& name : names) {
      const std::string one = axis_value(before, name, point.baseline);
      const std::string two = axis_value(after, name, point.current);
      if (one == two) continue;
      throw Failure(
          ExitCode::bad_data,
          fmt::format("{}: its design point '{}' is not that of {}: the axis {} is {} there and {} here",
                      current.path().string(), point.label, baseline.path().string(), name, one, two));
    }
  }
}

/// How the values of one drawn parameter in two files are related.
enum class InputRelation { equal, same_order, different };

InputRelation relation_of(const std::vector<double>& before, const std::vector<double>& after) {
  if (before == after) return InputRelation::equal;
  std::vector<std::size_t> order(before.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return before[a] != before[b] ? before[a] < before[b] : after[a] < after[b];
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (after[order[i]] < after[order[i - 1]]) return InputRelation::different;
  }
  return InputRelation::same_order;
}

const study::InputColumn* find_input(const reading::AllTrialsFile& file, const std::string& name) {
  const std::vector<study::InputColumn>& inputs = file.input_columns();
  const auto found = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const study::InputColumn& one) { return one.name == name; });
  return found == inputs.end() ? nullptr : &*found;
}

/// The worst relation of one parameter over all points.
InputRelation relation_over_points(std::size_t old_column, std::size_t new_column,
                                   const std::vector<MatchedPoint>& points, std::int64_t trials) {
  InputRelation worst = InputRelation::equal;
  for (const MatchedPoint& point : points) {
    const InputRelation relation =
        relation_of(point.in_baseline->input(old_column, point.baseline_rows(trials)),
                    point.in_current->input(new_column, point.current_rows(trials)));
    worst = std::max(worst, relation);
  }
  return worst;
}

}  // namespace

std::string axis_value(const std::vector<study::SweepAxis>& axes, const std::string& name,
                       std::int64_t point) {
  const auto at = static_cast<std::size_t>(point);
  for (const study::SweepAxis& axis : axes) {
    if (axis.name != name) continue;
    return axis.kind == study::SweepAxis::Kind::text ? axis.texts.at(at) : exact_text(axis.numbers.at(at));
  }
  return "missing";
}

std::vector<MatchedPoint> match_points(const reading::AllTrialsFile& baseline,
                                       const reading::AllTrialsFile& current) {
  const std::map<std::string, std::int64_t> old_points = points_by_label(baseline);
  const std::map<std::string, std::int64_t> new_points = points_by_label(current);
  require_same_names(baseline, baseline.point_labels(), current, current.point_labels(), "design points");
  std::vector<MatchedPoint> points;
  for (const std::string& label : baseline.point_labels()) {
    points.push_back({.label = label,
                      .baseline = old_points.at(label),
                      .current = new_points.at(label),
                      .design_point = label,
                      .in_baseline = &baseline,
                      .in_current = &current});
  }
  require_equal_axes(baseline, current, points);
  return points;
}

MatchedConditions::MatchedConditions(const reading::AllTrialsFile& baseline,
                                     const reading::AllTrialsFile& current)
    : names_(conditions_of(baseline)) {
  const bool one_file = &baseline == &current;
  if (!one_file) require_same_names(baseline, names_, current, conditions_of(current), "conditions");
  baseline_under_ = files_under(baseline, names_);
  if (!one_file) current_under_ = files_under(current, names_);
}

std::vector<MatchedPoint> MatchedConditions::points(const std::vector<MatchedPoint>& design_points) const {
  if (names_.empty()) return design_points;
  std::vector<MatchedPoint> points;
  for (const MatchedPoint& point : design_points) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      MatchedPoint& one = points.emplace_back(point);
      one.condition = names_[i];
      one.label = study::label_under(point.label, names_[i]);
      one.in_baseline = &baseline_under_[i];
      one.in_current = current_under_.empty() ? &baseline_under_[i] : &current_under_[i];
    }
  }
  return points;
}

DrawComparison compare_draws(const reading::AllTrialsFile& baseline, const reading::AllTrialsFile& current,
                             const manifest_text::ManifestValues& old_values,
                             const manifest_text::ManifestValues& new_values,
                             const std::vector<MatchedPoint>& points, std::int64_t trials) {
  if (baseline.header().seed != current.header().seed) return {false, "the seeds differ", {}};
  for (const auto& [key, absent] : {std::pair<std::string, std::string>{"design", "monte_carlo"},
                                    {"independent_points", "false"},
                                    {"worlds", "0"},
                                    {"rigs", "0"}}) {
    if (manifest_text::value_or(old_values, key, absent) !=
        manifest_text::value_or(new_values, key, absent)) {
      return {false, fmt::format("the manifests differ in {}", key), {}};
    }
  }
  DrawComparison result{true, "trial i drew the same random numbers in both", {}};
  for (std::size_t column = 0; column < baseline.input_columns().size(); ++column) {
    const std::string& name = baseline.input_columns()[column].name;
    const study::InputColumn* const partner = find_input(current, name);
    if (partner == nullptr) continue;
    const auto new_column = static_cast<std::size_t>(partner - current.input_columns().data());
    const InputRelation relation = relation_over_points(column, new_column, points, trials);
    if (relation == InputRelation::different) {
      return {false, fmt::format("trial i has other values of {}", name), {}};
    }
    if (relation == InputRelation::same_order) result.changed_inputs.push_back(name);
  }
  return result;
}

}  // namespace zerocount::comparison

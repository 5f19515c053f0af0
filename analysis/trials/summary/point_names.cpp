#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::summary {
namespace {

/// Whether a swept parameter differs between any two points, or has a distribution at a point (shown by NaN).
bool varies(const study::SweepAxis& axis) {
  const auto differs = [](const auto& values) {
    return std::any_of(values.begin(), values.end(), [&](const auto& v) { return !(v == values.front()); });
  };
  return axis.kind == study::SweepAxis::Kind::text ? differs(axis.texts) : differs(axis.numbers);
}

std::string last_parts(const std::string& path, std::size_t parts) {
  std::size_t start = path.size();
  for (; parts > 0 && start != std::string::npos && start > 0; --parts) start = path.rfind('.', start - 1);
  return start == std::string::npos ? path : path.substr(start + 1);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

}  // namespace

std::vector<const study::SweepAxis*> varying_parameters(std::span<const study::SweepAxis> axes) {
  std::vector<const study::SweepAxis*> found;
  for (const study::SweepAxis& axis : axes) {
    if (axis.name != "case" && varies(axis)) found.push_back(&axis);
  }
  return found;
}

std::string short_name(std::span<const study::SweepAxis> axes, const study::SweepAxis& axis) {
  const std::vector<const study::SweepAxis*> swept = varying_parameters(axes);
  const auto sections = std::count(axis.name.begin(), axis.name.end(), '.');
  for (std::size_t parts = 1; parts <= static_cast<std::size_t>(sections); ++parts) {
    std::string name = last_parts(axis.name, parts);
    const bool is_index = name.find_first_not_of("0123456789.") == std::string::npos;
    const bool unique = std::none_of(swept.begin(), swept.end(), [&](const study::SweepAxis* other) {
      return other->name != axis.name && last_parts(other->name, parts) == name;
    });
    if (unique && !is_index) return name;
  }
  return axis.name;
}

std::vector<std::string> short_labels(std::vector<std::string> labels,
                                      std::span<const study::SweepAxis> axes) {
  for (const study::SweepAxis& axis : axes) {
    const std::string name = short_name(axes, axis);
    for (std::string& label : labels) {
      replace_all(label, ", " + axis.name + "=", " " + name + "=");
      if (label.starts_with(axis.name + "=")) label.replace(0, axis.name.size(), name);
    }
  }
  return labels;
}

std::vector<std::string> point_names(const StudySummary& summary) {
  std::vector<std::string> names = short_labels(summary.labels, summary.axes);
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = names[i] == summary.labels[i] ? text::printable(names[i])
                                             : fmt::format("{} ({})", i, text::printable(names[i]));
  return names;
}

}  // namespace zerocount::summary

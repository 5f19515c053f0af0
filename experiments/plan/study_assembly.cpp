#include "experiments/plan/study_assembly.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "experiments/language/slots.hpp"

namespace zerocount {
namespace {

bool is_swept(const StudyPlan& plan, std::size_t slot) {
  return std::any_of(plan.axes.begin(), plan.axes.end(), [&](const PlanAxis& axis) {
    return std::any_of(axis.assignments.begin(), axis.assignments.end(),
                       [&](const Assignment& assignment) { return assignment.slot == slot; });
  });
}

void derive_randomness(const Study& study, StudyPlan& plan) {
  std::vector<std::size_t> dimensions;
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot)
    dimensions.push_back(slot_sobol_dimension(slot));
  const auto directions = study.design == Design::sobol ? sobol_directions(dimensions)
                                                        : std::vector<SobolDirections>(dimensions.size());
  for (std::size_t slot = 0; slot < plan.base.size(); ++slot) {
    plan.randomness.push_back({random_key(study.seed, slot_name(slot)), directions[slot]});
  }
}

std::string column_meaning(const Parameter& parameter) {
  std::string meaning(parameter.meaning);
  for (std::size_t i = 0; i < parameter.words.size(); ++i) {
    meaning += fmt::format("{}{} {}", i == 0 ? " (" : ", ", i, parameter.words[i]);
  }
  return parameter.words.empty() ? meaning : meaning + ")";
}

void list_input_columns(StudyPlan& plan, Study& study) {
  for (const std::size_t slot : slots_in_table_order(plan.moves)) {
    if (plan.base[slot].kind == Value::Kind::number && !is_swept(plan, slot)) continue;
    const Parameter& parameter = parameter_table()[row_of_slot(slot)];
    study.input_columns.push_back({slot_name(slot), std::string(parameter.unit), column_meaning(parameter)});
    plan.input_slots.push_back(static_cast<std::uint32_t>(slot));
  }
}

// The profiles of one row that some point uses, each with the first point that does.
std::map<std::uint32_t, std::size_t> profiles_in_use(const StudyPlan& plan, std::size_t row,
                                                     std::size_t points) {
  std::map<std::uint32_t, std::size_t> first_point;
  const std::size_t distinct_points = is_swept(plan, row) ? points : 1;
  for (std::size_t point = 0; point < distinct_points; ++point) {
    const Value& value = *value_at_point(plan, row, point);
    if (value.kind == Value::Kind::profile) first_point.emplace(value.index, point);
  }
  return first_point;
}

void list_profiles(const std::vector<ProfileRequest>& requests, const StudyPlan& plan, Study& study) {
  const auto table = parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const bool asked =
        std::any_of(requests.begin(), requests.end(), [&](const auto& r) { return r.row == row; });
    if (!asked) continue;
    const auto used = profiles_in_use(plan, row, study.point_labels.size());
    for (const auto& [index, point] : used) {
      const std::string suffix = used.size() > 1 ? fmt::format("@{}", point) : "";
      study.profiles.push_back(
          {std::string(table[row].name) + suffix, std::string(table[row].unit), plan.profiles[index]});
    }
  }
}

}  // namespace

void realise_profiles(const std::vector<ProfileRequest>& requests, std::uint64_t seed, StudyPlan& plan) {
  for (const ProfileRequest& request : requests) {
    plan.profiles.push_back(std::make_shared<const Profile>(
        realise_profile(request.description, seed, parameter_table()[request.row].name)));
  }
}

void assemble_study(const std::vector<ProfileRequest>& requests, const std::vector<SweptAxis>& axes,
                    StudyPlan& plan, Study& study) {
  study.moves = static_cast<std::int64_t>(plan.moves);
  study.point_labels = label_points(axes);
  study.axes = describe_axes(axes, plan);
  derive_randomness(study, plan);
  list_input_columns(plan, study);
  list_profiles(requests, plan, study);
}

}  // namespace zerocount

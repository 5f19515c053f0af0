#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

// The names of the rows, of long lists only the first ones.
std::vector<std::string> assigned_names(const study::StudyTable& table) {
  constexpr std::size_t max_of_studies = 100;
  const std::size_t count =
      std::min(table.rows.size(), parameters::parameter_table().size() + max_of_studies);
  std::vector<std::string> names;
  for (std::size_t row = 0; row < count; ++row) names.emplace_back(table.rows[row].name);
  return names;
}

// The names of the values of the list of elements or coefficients to which an unknown path leads.
std::string names_like(const study::StudyTable& table, std::string_view pattern) {
  std::vector<std::string_view> names;
  for (const parameters::Parameter& row : table.rows) {
    const std::string known = parameters::without_indices(row.name);
    if (parameters::has_value(row) && known != row.name &&
        keys::is_within(pattern, known.substr(0, known.find(".#"))))
      names.push_back(row.name);
  }
  return names.empty() ? "" : fmt::format("one of {}", fmt::join(names, ", "));
}

/// The dotted path of the parameter of whose aging the key is the rate ("friction.k1" for
/// "friction.k1.aging"); empty if the key is not a rate of aging.
std::string aged_parameter(const study::StudyTable& table, std::string_view key) {
  if (!key.ends_with(study::suffix_of_rate)) return "";
  key.remove_suffix(study::suffix_of_rate.size());
  return study::find_slots(key, table) ? std::string(key) : std::string();
}

}  // namespace

bool is_of_spectrum(const study::StudyPlan& plan, std::string_view path) {
  for (const parameters::ElementList& list : parameters::element_lists()) {
    if (!parameters::has_spectra(list)) continue;
    const bool of_load = list.path.starts_with("disturbance.load.");
    const auto& elements = (of_load ? plan.common.load_side.disturbance : plan.common.disturbance).vibration;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const std::string element = fmt::format("{}.{}", list.path, i);
      const bool is_spectrum = !study::find_slots(element + ".amplitude", plan.table);
      if (is_spectrum && (path == element + ".lines" || path.starts_with(element + ".spectrum"))) return true;
    }
  }
  return false;
}

std::optional<study::SlotRange> find_assigned(const yaml::Field& map, const yaml::YamlEntry& entry,
                                              std::string_view refusal, keys::StudyDraft& draft) {
  const study::StudyTable& table = draft.plan.table;
  if (auto slots = study::find_slots(entry.key, table)) return slots;
  // The parameters of a plugin that could not be loaded, which is reported, are not known.
  if (draft.plugin_failed && keys::is_within(entry.key, "controller.parameters")) return std::nullopt;
  yaml::Problems& problems = draft.problems;
  const std::string path = yaml::entry_of(map, entry).path;
  const std::string pattern = parameters::without_indices(entry.key);
  const bool of_element = parameters::find_element_list(pattern.substr(0, pattern.find(".#"))) != nullptr;
  if (is_of_spectrum(draft.plan, entry.key)) {
    problems.add(entry.place, path, fmt::format("{} is not a parameter: a spectrum is fixed", entry.key),
                 "a parameter, or a manifest for each spectrum");
  } else if (of_element && pattern != entry.key) {
    const std::string known = names_like(table, pattern);
    problems.add(entry.place, path, fmt::format("the study has no {}", entry.key),
                 known.empty() ? "the list in its section of the manifest" : known);
  } else if (const auto row = study::find_list_row(entry.key)) {
    const parameters::Parameter& list = table.rows[*row];
    if (const auto values = study::find_list(table, *row)) {
      problems.add(entry.place, path, fmt::format("the study has no {} with this index", list.list->singular),
                   fmt::format("an index from 0 to {}", values->count - 1));
    } else {
      problems.add(entry.place, path, fmt::format("the study has no {}", list.name),
                   keys::is_within(list.name, keys::required_section)
                       ? fmt::format("{}, which it has", table.rows[draft.plan.list.row].name)
                       : "the list in its section of the manifest");
    }
  } else if (const std::string aged = aged_parameter(table, entry.key); !aged.empty()) {
    problems.add(entry.place, path, fmt::format("{} does not change with age in its section", aged),
                 fmt::format("{}: {{value: …, aging: {{exponential: -0.1, scale: 1.0e+6}}}} there", aged));
  } else if (keys::find_general_key(entry.key) != nullptr) {
    problems.add(entry.place, path, std::string(refusal),
                 "a dotted path of the table of parameters, such as controller.ki");
  } else {
    parameters::add_unknown_key(map, entry, assigned_names(table), problems);
  }
  return std::nullopt;
}

void assign(SweptAxis& axis, std::size_t slot, const study::Value& value, const yaml::Place& place) {
  axis.axis.assignments.push_back({static_cast<std::uint32_t>(slot), value});
  axis.places.push_back(place);
}

void finish_option(SweptAxis& axis, std::string label) {
  axis.axis.first.push_back(static_cast<std::uint32_t>(axis.axis.assignments.size()));
  axis.labels.push_back(std::move(label));
}

std::string_view noun_of(const study::SlotRange& list, const study::StudyTable& table) {
  for (const study::RowGroup& group : table.groups) {
    const parameters::Parameter& row = table.rows[group.row];
    if (group.first == list.first && parameters::is_list(row)) return row.list->plural;
  }
  return "values";
}

}  // namespace zerocount::sections

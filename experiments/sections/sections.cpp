#include "experiments/sections/sections.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

struct SectionReader {
  const yaml::Field& root;
  keys::StudyDraft& draft;
  keys::PlanPlaces& places;
  std::string form{};  ///< key of the section `command` that defines the moves, such as "targets"

  yaml::Problems& problems() { return draft.problems; }
  study::StudyPlan& plan() { return draft.plan; }
};

// Gives every row of the study's table a slot.
void add_slots(SectionReader& s) {
  const std::size_t slots = s.plan().table.rows.size();
  s.plan().base.resize(slots, keys::unreadable_value());
  s.places.base.resize(slots, s.root.node->place);
  s.places.written.resize(slots, false);
}

void read_slot(SectionReader& s, const yaml::Field& field, std::size_t slot) {
  const auto take = [&](std::size_t taken, const study::Value& value) {
    s.plan().base[taken] = value;
    s.places.base[taken] = field.node->place;
    s.places.written[taken] = true;
  };
  take(slot, keys::read_value(field, slot, s.draft));
  if (!s.draft.rate) return;
  add_slots(s);
  take(s.draft.rate->slot, s.draft.rate->value);
}

void read_list(SectionReader& s, const yaml::Field& field, std::size_t row) {
  const parameters::ListOfValues list = s.plan().table.rows[row].list.value();
  const std::string expected = fmt::format("a list of {}", parameters::length_text(list));
  if (!yaml::check_list(field, expected, s.problems())) return;
  const std::size_t count = field.node->items.size();
  if (count < list.min_values || count > list.max_values) {
    s.problems().add(field, fmt::format("found a list of {}", count), expected);
    return;
  }
  const study::RowGroup values = study::add_list(s.plan().table, row, count);
  if (row == s.plan().list.row) s.plan().list = values;
  add_slots(s);
  for (std::size_t i = 0; i < count; ++i) read_slot(s, yaml::item_of(field, i), values.first + i);
}

// Gives a study whose manifest lacks the list of moves one with an unreadable value; that of a record the
// level or the target 0, and a hold as long as the record. That of a recorded reference depends on the sample
// rate, and study_trial() sets it for each trial.
void complete_moves(SectionReader& s) {
  study::RowGroup& list = s.plan().list;
  if (list.count > 0) return;
  list = study::add_list(s.plan().table, list.row, 1);
  add_slots(s);
  const trial::CommandParameters& command = s.plan().common.command;
  if (!command.torque.record && !command.profile.record) return;
  s.plan().base[list.first] = study::Value{};
  const std::size_t hold = study::find_slots(parameter::command::hold, s.plan().table).value().first;
  if (s.places.written[hold]) return;
  s.plan().base[hold].number = command.torque.record ? trial::record_duration(*command.torque.record)
                                                     : rules::hold_of_the_reference(s.plan());
}

// Reads the record that command.torque.file or command.reference.file has in place of levels or targets. A
// name that is still there is that of a table whose problems are reported already; see table_overrides().
void read_record(SectionReader& s, const yaml::Field& field) {
  s.places.record = field.node->place;
  if (field.node->kind == yaml::YamlNode::Kind::scalar && !s.problems().empty()) return;
  trial::CommandParameters& command = s.plan().common.command;
  if (s.plan().open_loop) {
    command.torque.record = read_torque_record(field, s.problems());
    return;
  }
  command.profile.record = read_reference_record(field, s.problems());
  const std::size_t shape =
      study::find_slots(parameter::command::profile::shape, s.plan().table).value().first;
  s.plan().base[shape] = {.number = static_cast<double>(loop::ReferenceShape::record)};
}

void read_parameter(SectionReader& s, const yaml::Field& field, std::size_t row) {
  if (parameters::is_list(s.plan().table.rows[row])) return read_list(s, field, row);
  read_slot(s, field, row);
}

std::string names_of(std::span<const parameters::ElementForm> forms) {
  std::vector<std::string_view> names;
  for (const parameters::ElementForm& form : forms) names.push_back(form.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

// The first form without a name that exists on this kind of axis.
const parameters::ElementForm* find_form_by_keys(SectionReader& s, const yaml::Field& element,
                                                 const parameters::ElementList& list) {
  if (!yaml::check_map(element, "a map", s.problems())) return nullptr;
  const auto exists = [&](std::string_view key) {
    const auto row = parameters::find_parameter(fmt::format("{}.#.{}", list.path, key));
    return parameters::exists_on(parameters::parameter_table()[row.value()], s.plan().units.axis);
  };
  const auto form = std::find_if(list.forms.begin(), list.forms.end(), [&](const auto& known) {
    return std::all_of(known.keys.begin(), known.keys.end(), exists);
  });
  return &*form;
}

// The form that an element has. Reports anything else, and returns null.
const parameters::ElementForm* find_form(SectionReader& s, const yaml::Field& element,
                                         const parameters::ElementList& list) {
  if (list.forms.front().name.empty()) return find_form_by_keys(s, element, list);
  const std::string expected = fmt::format("a map with one of {}", names_of(list.forms));
  if (!yaml::check_map(element, expected, s.problems())) return nullptr;
  const auto& entries = element.node->entries;
  if (entries.size() != 1) {
    s.problems().add(element, fmt::format("found a map with {} keys", entries.size()), expected);
    return nullptr;
  }
  const auto form = std::find_if(list.forms.begin(), list.forms.end(),
                                 [&](const auto& known) { return known.name == entries[0].key; });
  if (form != list.forms.end()) return &*form;
  s.problems().add(entries[0].place, yaml::entry_of(element, entries[0]).path,
                   fmt::format("unknown {}", list.element), expected);
  return nullptr;
}

void read_element(SectionReader& s, const yaml::Field& element, std::size_t index,
                  const parameters::ElementList& list) {
  if (parameters::has_spectra(list) && is_spectrum(element)) {
    list.add(s.plan().common, 0);  // a line of amplitude 0, so that places in the list and in the trial agree
    if (const auto spectrum = read_spectrum(element, s.problems()))
      (list.path.starts_with("disturbance.load.") ? s.plan().common.load_side.disturbance
                                                  : s.plan().common.disturbance)
          .spectra.push_back(spectrum);
    return;
  }
  const parameters::ElementForm* const form = find_form(s, element, list);
  if (form == nullptr) return;
  const yaml::Field map = form->name.empty() ? element : yaml::entry_of(element, element.node->entries[0]);
  const std::vector<std::string> keys(form->keys.begin(), form->keys.end());
  if (!yaml::check_map(map, fmt::format("a map with the keys {}", fmt::join(keys, ", ")), s.problems()))
    return;
  parameters::check_keys(map, keys, s.problems());
  const study::RowGroup rows = study::add_element(s.plan().table, list, index, *form);
  list.add(s.plan().common, static_cast<std::size_t>(form - list.forms.data()));
  add_slots(s);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const parameters::Parameter& row = s.plan().table.rows[rows.first + i];
    if (const auto value = yaml::find_field(map, keys[i])) {
      read_parameter(s, *value, rows.first + i);
    } else if (parameters::has_default(row)) {
      s.plan().base[rows.first + i].number = parameters::default_value(row);
    } else {
      s.problems().add_missing(
          map.node->place, fmt::format("{}.{}", map.path, keys[i]),
          fmt::format("its value: {}",
                      parameters::meaning_of(s.plan().table.rows[rows.first + i], s.plan().units)));
    }
  }
}

void read_elements(SectionReader& s, const yaml::Field& field, const parameters::ElementList& list) {
  const std::string expected = fmt::format("a list of at most {} {}s", list.max_elements, list.element);
  if (!yaml::check_list(field, expected, s.problems())) return;
  const std::size_t count = field.node->items.size();
  if (count > list.max_elements) {
    s.problems().add(field, fmt::format("found a list of {}", count), expected);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) read_element(s, yaml::item_of(field, i), i, list);
}

void add_plugin_parameters(SectionReader& s) {
  if (!s.plan().plugin) return;
  const plugin::PluginDescription& plugin = s.plan().plugin->description;
  const study::RowGroup rows = study::add_plugin(s.plan().table, plugin);
  add_slots(s);
  loop::UserControl& user = s.plan().common.controller.user;
  user.plugin = s.plan().plugin;
  for (const plugin::PluginParameter& parameter : plugin.parameters) {
    s.plan().base[rows.first + user.parameters.size()].number = parameter.default_value;
    user.parameters.push_back(parameter.default_value);
  }
}

void read_plugin_parameters(SectionReader& s, const yaml::Field& map) {
  if (!s.plan().plugin) {
    // With a plugin that cannot be used, which is reported, its parameters are not known.
    const auto controller = yaml::find_field(s.root, "controller");
    if (!yaml::find_field(*controller, "plugin"))
      s.problems().add(map, "these parameters belong to a plugin, but there is none",
                       "controller.plugin, or the key left out");
    return;
  }
  if (!yaml::check_map(map, "a map", s.problems())) return;
  std::vector<std::string> names;
  for (const plugin::PluginParameter& parameter : s.plan().plugin->description.parameters)
    names.push_back(parameter.name);
  for (const yaml::YamlEntry& entry : map.node->entries) {
    const yaml::Field field = yaml::entry_of(map, entry);
    if (std::find(names.begin(), names.end(), entry.key) == names.end()) {
      parameters::add_unknown_key(map, entry, names, s.problems());
    } else {
      read_slot(s, field, study::find_slots(field.path, s.plan().table).value().first);
    }
  }
}

// Reads the keys of sections that are not parameters. controller.units and command.units are read earlier,
// before all values.
void read_general_key(SectionReader& s, const yaml::Field& field, const shapes::Shape& key) {
  if (field.path == "command.torque.file" || field.path == "command.reference.file") {
    read_record(s, field);
  } else if (!field.path.ends_with(".units")) {
    shapes::read(field, key, s.problems(), &s.draft);
  }
}

bool is_form(std::string_view key) {
  return std::find(keys::command_forms.begin(), keys::command_forms.end(), key) != keys::command_forms.end();
}

// Whether the path belongs to a second form of the command. Its contents are not read: it is reported as one
// form too many.
bool is_form_too_many(SectionReader& s, const yaml::Field& section, const std::string& key) {
  return section.path == keys::required_section && is_form(key) && key != s.form;
}

// Whether the key of a section stands in short for one of its parameters: its value is a number or a
// distribution.
bool is_short_form(const yaml::Field& field) {
  if (field.node->kind != yaml::YamlNode::Kind::map) return true;
  return std::any_of(
      field.node->entries.begin(), field.node->entries.end(), [](const yaml::YamlEntry& entry) {
        const auto forms = distributions::distribution_forms();
        return entry.key == keys::aging_key || std::any_of(forms.begin(), forms.end(), [&](const auto& form) {
                 return form.name == entry.key;
               });
      });
}

void read_section(SectionReader& s, const yaml::Field& section) {
  const std::vector<std::string> known = keys::keys_below(section.path);
  const std::string expected = fmt::format("a map of keys, such as {}: {{{}: ...}}",
                                           section.path.substr(section.path.rfind('.') + 1), known.front());
  if (!yaml::check_map(section, expected, s.problems())) return;
  for (const yaml::YamlEntry& entry : section.node->entries) {
    const yaml::Field field = yaml::entry_of(section, entry);
    if (is_form_too_many(s, section, entry.key)) continue;
    if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
      parameters::add_unknown_key(section, entry, known, s.problems());
    } else if (const auto row = parameters::find_parameter(field.path);
               row && (!keys::is_section(field.path) || is_short_form(field))) {
      read_parameter(s, field, *row);
    } else if (const parameters::ElementList* const list = parameters::find_element_list(field.path)) {
      read_elements(s, field, *list);
    } else if (field.path == "controller.parameters") {
      read_plugin_parameters(s, field);
    } else if (const shapes::Shape* const general = keys::find_general_key(field.path)) {
      read_general_key(s, field, *general);
    } else {
      read_section(s, field);
    }
  }
}

void take_defaults(SectionReader& s) {
  add_slots(s);
  const auto table = parameters::parameter_table();
  for (std::size_t row = 0; row < table.size(); ++row) {
    const bool known =
        parameters::has_default(table[row]) && parameters::exists_on(table[row], s.plan().units.axis);
    s.plan().base[row] = keys::unreadable_value();
    if (known) s.plan().base[row].number = parameters::default_value(table[row]);
    if (table[row].only_on && !known) s.plan().base[row].number = 0.0;
  }
}

// Chooses the first form in the manifest; reports an error unless there is exactly one.
void choose_form(SectionReader& s, const yaml::Field& command) {
  if (command.node->kind != yaml::YamlNode::Kind::map) return;
  const std::string expected = fmt::format("exactly one of {}", fmt::join(keys::command_forms, ", "));
  std::vector<const yaml::YamlEntry*> given;
  for (const yaml::YamlEntry& entry : command.node->entries) {
    if (is_form(entry.key)) given.push_back(&entry);
  }
  if (given.empty()) {
    s.problems().add(command, "the moves have no targets", expected);
    return;
  }
  if (given.size() > 1) {
    s.problems().add(given[1]->place, yaml::entry_of(command, *given[1]).path,
                     fmt::format("{} already defines the moves", yaml::entry_of(command, *given[0]).path),
                     expected);
  }
  s.form = given.front()->key;
  s.plan().open_loop = s.form == "torque";
  if (s.form == "sequence") s.plan().sequence.emplace();
  const std::string_view list = s.form == "torque"     ? parameter::command::torque::levels
                                : s.form == "sequence" ? parameter::command::sequence::targets
                                                       : parameter::command::targets;
  s.plan().list.row = parameters::find_parameter(list).value();
}

// Reports the keys of the form chosen that are missing.
void check_form_complete(SectionReader& s, const yaml::Field& command) {
  const auto form = yaml::find_field(command, s.form);
  if (!form || form->node->kind != yaml::YamlNode::Kind::map || yaml::find_field(*form, "file")) return;
  for (const std::string& key : keys::keys_below(form->path)) {
    const std::string name = fmt::format("{}.{}", form->path, key);
    if (const shapes::Shape* const general = keys::find_general_key(name); general && general->required())
      s.problems().add_missing(form->node->place, name, general->if_missing);
    const auto row = parameters::find_parameter(name);
    if (!row || parameters::has_default(parameters::parameter_table()[*row]) || yaml::find_field(*form, key))
      continue;
    const parameters::Parameter& parameter = parameters::parameter_table()[*row];
    s.problems().add_missing(
        form->node->place, name,
        parameters::is_list(parameter)
            ? fmt::format("a list of {}", key)
            : fmt::format("its value: {}", parameters::meaning_of(parameter, s.plan().units)));
  }
}

void check_sequence_length(SectionReader& s, const yaml::Field& command) {
  if (!s.plan().sequence) return;
  const std::int64_t moves =
      study::sequence_move_count(*s.plan().sequence, static_cast<std::int64_t>(s.plan().list.count));
  if (moves <= study::max_sequence_moves) return;
  s.problems().add(yaml::find_field(command, "sequence").value(), fmt::format("it has {} moves", moves),
                   fmt::format("at most {} moves in all cycles", study::max_sequence_moves));
}

}  // namespace

void read_sections(const yaml::Field& root, keys::StudyDraft& draft, keys::PlanPlaces& places) {
  SectionReader s{root, draft, places};
  const auto command = yaml::find_field(root, keys::required_section);
  draft.plan.list.row = parameters::find_parameter(parameter::command::targets).value();
  if (command) {
    choose_form(s, *command);
  } else {
    draft.problems.add_missing(root.node->place, keys::required_section, "command: {targets: [..]}");
  }
  take_defaults(s);
  add_plugin_parameters(s);
  for (const std::string& key : keys::keys_below("")) {
    const auto section = keys::is_section(key) ? yaml::find_field(root, key) : std::nullopt;
    if (section) read_section(s, *section);
  }
  complete_moves(s);
  if (!command) return;
  check_form_complete(s, *command);
  check_sequence_length(s, *command);
}

}  // namespace zerocount::sections

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/text/trimmed.hpp"
#include "experiments/keys/draw_level.hpp"
#include "experiments/manifest_text/overrides.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/sections/joint_draws.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

constexpr const char* samples_form = "the name of a file, or {file: posterior.csv, per: rig}";

struct Cell {
  std::string_view text;
  yaml::Place place;
};

std::string_view without_quotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::vector<Cell> cells_of(std::string_view line, int number, std::string_view source) {
  std::vector<Cell> cells;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back({without_quotes(text::trimmed(line.substr(begin, end - begin))),
                     {source, number, static_cast<int>(begin) + 1}});
    if (end == line.size()) return cells;
    begin = end + 1;
  }
}

/// The rows of a table of comma-separated cells, the header first. Empty lines and those that begin with #
/// are left out.
std::vector<std::vector<Cell>> rows_of(std::string_view text, std::string_view source) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::vector<std::vector<Cell>> rows;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (!text::trimmed(line).empty() && !line.starts_with('#'))
      rows.push_back(cells_of(line, number, source));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return rows;
}

bool check_shape(const std::vector<std::vector<Cell>>& rows, const SamplesTable& table,
                 yaml::Problems& problems) {
  const std::size_t draws = rows.empty() ? 0 : rows.size() - 1;
  if (draws == 0 || draws > max_samples) {
    problems.add({table.source, 1, 1}, "samples", fmt::format("the table has {} draws", draws),
                 fmt::format("a header with dotted paths, and 1 to {} rows of numbers", max_samples));
    return false;
  }
  for (const std::vector<Cell>& row : rows) {
    if (row.size() == rows.front().size()) continue;
    problems.add(row.front().place, "samples",
                 fmt::format("the row has {} cells, and the header {}", row.size(), rows.front().size()),
                 "a number for each column");
    return false;
  }
  return true;
}

yaml::YamlPointer scalar(const Cell& cell) {
  auto node = std::make_shared<yaml::YamlNode>();
  node->kind = yaml::YamlNode::Kind::scalar;
  node->place = cell.place;
  node->text = cell.text;
  return node;
}

std::shared_ptr<yaml::YamlNode> map_at(const yaml::Place& place) {
  auto node = std::make_shared<yaml::YamlNode>();
  node->kind = yaml::YamlNode::Kind::map;
  node->place = place;
  return node;
}

/// {choice: [the cells of the column]}, with the key `per` of the samples.
yaml::YamlPointer choice_of(const std::vector<std::vector<Cell>>& rows, std::size_t column,
                            const std::optional<yaml::Field>& per) {
  const yaml::Place& place = rows.front()[column].place;
  auto list = std::make_shared<yaml::YamlNode>();
  list->kind = yaml::YamlNode::Kind::list;
  list->place = place;
  for (std::size_t row = 1; row < rows.size(); ++row) list->items.push_back(scalar(rows[row][column]));
  auto value = map_at(place);
  value->entries.push_back({"choice", place, std::move(list)});
  if (per) {
    auto node = std::make_shared<yaml::YamlNode>(*per->node);
    value->entries.push_back({std::string(keys::per_key), place, std::move(node)});
  }
  return value;
}

/// True if the column can have this name; reports an error if it cannot.
bool check_name(const Cell& name, const std::set<std::string_view>& earlier, const yaml::YamlPointer& root,
                yaml::Problems& problems) {
  const char* const expected = "the dotted path of a parameter, such as friction.k1";
  if (!manifest_text::is_dotted_path(name.text)) {
    problems.add(name.place, "samples", fmt::format("the column {} has no name", yaml::in_quotes(name.text)),
                 expected);
  } else if (earlier.contains(name.text)) {
    problems.add(name.place, name.text, "duplicate column", "each parameter once");
  } else if (!parameters::find_parameter(name.text) && !name.text.starts_with("controller.parameters.")) {
    problems.add(name.place, name.text, "unknown parameter, or an item of a list", expected);
  } else if (manifest_text::has_value_at(*root, name.text)) {
    problems.add(name.place, name.text, "the manifest also gives this parameter a value",
                 "the column or the key in the manifest, not both");
  } else {
    return true;
  }
  return false;
}

/// The file and `per` of the key; reports an error if they cannot be read.
std::optional<yaml::Field> find_file(const yaml::Field& field, yaml::Problems& problems) {
  if (field.node->kind != yaml::YamlNode::Kind::map) return field;
  parameters::check_keys(field, std::vector<std::string>{"file", std::string(keys::per_key)}, problems);
  auto file = yaml::find_field(field, "file");
  if (!file) problems.add(field, "the key 'file' is missing", samples_form);
  return file;
}

std::optional<std::string> read_table(const yaml::Field& file, const SamplesReader& read,
                                      yaml::Problems& problems) {
  const auto path = yaml::read_line(file, problems);
  if (!path) return std::nullopt;
  if (!read) {
    problems.add(file, "this command does not read samples", "the command check, run or trace");
    return std::nullopt;
  }
  std::string text = read(*path, "a table of samples");
  const bool zero = text.find('\0') != std::string::npos;
  if (!zero && text.size() <= max_samples_size) return text;
  problems.add(file, zero ? "the file contains a zero byte" : "the file is too large",
               fmt::format("a table of comma-separated numbers of at most {} bytes", max_samples_size));
  return std::nullopt;
}

/// True if the values of the sampled slots are drawn equally often; reports an error if they are not.
bool check_draw_levels(const SamplesTable& table, const std::vector<std::uint32_t>& slots,
                       keys::Reading& reading) {
  const auto level_of = [&](std::uint32_t slot) { return reading.plan.base[slot].level; };
  const auto other = std::find_if(slots.begin(), slots.end(), [&](std::uint32_t slot) {
    return level_of(slot) != level_of(slots.front());
  });
  if (other == slots.end()) return true;
  const auto text_of = [&](std::uint32_t slot) {
    return fmt::format("{} for each {}", reading.plan.table.rows[slot].name,
                       keys::draw_level_labels[static_cast<std::size_t>(level_of(slot))]);
  };
  reading.problems.add(table.field,
                       fmt::format("a row is drawn as a whole, but the defaults of `per` differ: {}, and {}",
                                   text_of(slots.front()), text_of(*other)),
                       "{file: ..., per: rig}, or per: world or trial");
  return false;
}

bool check_not_swept(const SamplesTable& table, const std::vector<std::uint32_t>& slots,
                     const std::vector<SweptAxis>& axes, keys::Reading& reading) {
  for (std::size_t column = 0; column < slots.size(); ++column) {
    const bool swept = std::any_of(axes.begin(), axes.end(), [&](const SweptAxis& axis) {
      return std::find(axis.slots.begin(), axis.slots.end(), slots[column]) != axis.slots.end();
    });
    if (!swept) continue;
    reading.problems.add(table.columns[column], table.samples.parameters[column],
                         "the sweep also gives this parameter a value", "the column or the sweep, not both");
    return false;
  }
  return true;
}

}  // namespace

void insert_samples(yaml::YamlPointer& root, const SamplesReader& read, std::optional<SamplesTable>& table,
                    yaml::Problems& problems) {
  const auto field = yaml::find_field({root.get(), ""}, "samples");
  if (!field) return;
  const auto file = find_file(*field, problems);
  if (!file) return;
  auto text = read_table(*file, read, problems);
  if (!text) return;
  SamplesTable& read_in = table.emplace();
  read_in.samples.file = file->node->text;
  read_in.samples.text = std::move(*text);
  read_in.source = read_in.samples.file;
  read_in.field = *field;
  const std::vector<std::vector<Cell>> rows = rows_of(read_in.samples.text, read_in.source);
  if (!check_shape(rows, read_in, problems)) return;
  read_in.samples.rows = static_cast<std::int64_t>(rows.size()) - 1;
  const auto per = yaml::find_field(*field, keys::per_key);
  std::set<std::string_view> names;
  yaml::YamlPointer changed = root;
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    const Cell& name = rows.front()[column];
    if (!check_name(name, names, root, problems)) continue;
    names.insert(name.text);
    read_in.samples.parameters.emplace_back(name.text);
    read_in.columns.push_back(name.place);
    if (auto with =
            manifest_text::with_value(changed, name.text, choice_of(rows, column, per), name.place, problems))
      changed = std::move(with);
  }
  root = std::move(changed);
}

void join_samples(const SamplesTable& table, const std::vector<SweptAxis>& axes, keys::Reading& reading) {
  if (reading.study.design == study::Design::saltelli) {
    reading.problems.add(table.field, "the design saltelli needs independent parameters", "another design");
    return;
  }
  std::vector<std::uint32_t> slots;
  for (const std::string& name : table.samples.parameters) {
    const auto range = study::find_slots(name, reading.plan.table);
    if (!range || reading.plan.base[range->first].kind != study::Value::Kind::distribution)
      return;  // reported where it was read
    slots.push_back(static_cast<std::uint32_t>(range->first));
  }
  if (slots.empty()) return;  // the table could not be read, which is reported
  if (!check_not_swept(table, slots, axes, reading) || !check_draw_levels(table, slots, reading)) return;
  reading.study.samples = table.samples;
  reading.study.samples->level = reading.plan.base[slots.front()].level;
  reading.plan.sampled_slots = std::move(slots);
}

}  // namespace zerocount::sections

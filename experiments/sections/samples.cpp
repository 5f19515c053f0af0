#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {
namespace {

yaml::Place place_in(const SamplesTable& samples, std::size_t line, std::size_t column) {
  return {samples.source, static_cast<int>(line), static_cast<int>(column)};
}

std::shared_ptr<yaml::YamlNode> node_at(const yaml::Place& place, yaml::YamlNode::Kind kind) {
  auto node = std::make_shared<yaml::YamlNode>();
  node->kind = kind;
  node->place = place;
  return node;
}

/// A distribution that stands for one column of joint draws in the manifest: the node {choice: [cells of the
/// column]}, with the key `per` (how often it is drawn) of the samples.
yaml::YamlPointer choice_of(const SamplesTable& samples, const tables::TextTable& table, std::size_t column,
                            const yaml::Place& place) {
  const auto list = node_at(place, yaml::YamlNode::Kind::list);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto cell =
        node_at(place_in(samples, table.line(row), table.place(row, column)), yaml::YamlNode::Kind::scalar);
    cell->text = table.cell(row, column);
    list->items.push_back(cell);
  }
  const auto value = node_at(place, yaml::YamlNode::Kind::map);
  value->entries.push_back({"choice", place, list});
  if (const auto per = yaml::find_field(samples.field, keys::per_key))
    value->entries.push_back(
        {std::string(keys::per_key), place, std::make_shared<yaml::YamlNode>(*per->node)});
  return value;
}

/// Whether a column of the table of joint draws can have this name: the dotted path of a parameter that the
/// manifest does not give. Reports an error if it cannot.
bool check_name(std::string_view name, const yaml::Place& place, const yaml::YamlPointer& root,
                yaml::Problems& problems) {
  const char* const expected = "the dotted path of a parameter, such as friction.k1";
  if (!manifest_text::is_dotted_path(name)) {
    problems.add(place, "samples", fmt::format("the column {} has no name", yaml::in_quotes(name)), expected);
  } else if (!parameters::find_parameter(name) && !name.starts_with("controller.parameters.")) {
    problems.add(place, name, "unknown parameter, or an item of a list", expected);
  } else if (manifest_text::has_value_at(*root, name)) {
    problems.add(place, name, "the manifest also gives this parameter a value",
                 "the column or the key in the manifest, not both");
  } else {
    return true;
  }
  return false;
}

/// Reads the table of joint draws that the key `samples` names; empty after an error, which is reported.
std::optional<tables::TextTable> read_samples(const yaml::Field& file, const SamplesReader& read,
                                              SamplesTable& samples, yaml::Problems& problems) {
  if (!read) {
    problems.add(file, "this command does not read samples", "the command check, run or trace");
    return std::nullopt;
  }
  std::string text = read(file.node->text, "a table of samples");
  const bool zero = text.find('\0') != std::string::npos;
  if (zero || text.size() > max_samples_size) {
    problems.add(file, zero ? "the file contains a zero byte" : "the file is too large",
                 fmt::format("a table of comma-separated numbers of at most {} bytes", max_samples_size));
    return std::nullopt;
  }
  samples.samples.text = text;
  const std::string expected =
      fmt::format("a header with dotted paths, and 1 to {} rows of numbers", max_samples);
  const yaml::Field named{file.node, "samples"};
  auto table = read_table(named, std::move(text), expected, problems);
  if (!table || (table->rows() > 0 && table->rows() <= max_samples)) return table;
  problems.add(place_in(samples, 1, 1), "samples", fmt::format("the table has {} draws", table->rows()),
               expected);
  return std::nullopt;
}

/// Whether the values of the sampled slots (parameters of the joint draws) are drawn equally often; reports
/// an error if they are not.
bool check_draw_levels(const SamplesTable& table, const std::vector<std::uint32_t>& slots,
                       keys::StudyDraft& draft) {
  const auto level_of = [&](std::uint32_t slot) { return draft.plan.base[slot].level; };
  const auto other = std::find_if(slots.begin(), slots.end(), [&](std::uint32_t slot) {
    return level_of(slot) != level_of(slots.front());
  });
  if (other == slots.end()) return true;
  const auto text_of = [&](std::uint32_t slot) {
    return fmt::format("{} for each {}", draft.plan.table.rows[slot].name,
                       keys::draw_level_labels[static_cast<std::size_t>(level_of(slot))]);
  };
  draft.problems.add(table.field,
                     fmt::format("a row is drawn as a whole, but the defaults of `per` differ: {}, and {}",
                                 text_of(slots.front()), text_of(*other)),
                     "{file: ..., per: machine}, or per: world or trial");
  return false;
}

bool check_not_swept(const SamplesTable& table, const std::vector<std::uint32_t>& slots,
                     const std::vector<SweptAxis>& axes, keys::StudyDraft& draft) {
  for (std::size_t column = 0; column < slots.size(); ++column) {
    const bool swept = std::any_of(axes.begin(), axes.end(), [&](const SweptAxis& axis) {
      return std::find(axis.slots.begin(), axis.slots.end(), slots[column]) != axis.slots.end();
    });
    if (!swept) continue;
    draft.problems.add(table.columns[column], table.samples.parameters[column],
                       "the sweep also gives this parameter a value", "the column or the sweep, not both");
    return false;
  }
  return true;
}

}  // namespace

void insert_samples(yaml::YamlPointer& root, const SamplesReader& read, std::optional<SamplesTable>& table,
                    yaml::Problems& problems) {
  const auto field = yaml::find_field({root.get(), ""}, "samples");
  if (!field || !shapes::read(*field, keys::shape_of("samples"), problems)) return;
  const yaml::Field file = yaml::find_field(*field, "file").value_or(*field);
  SamplesTable& samples = table.emplace();
  samples.samples.file = samples.source = file.node->text;
  samples.field = *field;
  const auto read_in = read_samples(file, read, samples, problems);
  if (!read_in) return;
  samples.samples.rows = static_cast<std::int64_t>(read_in->rows());
  yaml::YamlPointer changed = root;
  for (std::size_t column = 0; column < read_in->columns(); ++column) {
    const std::string_view name = read_in->header_cell(column);
    const yaml::Place place = place_in(samples, read_in->header_line(), read_in->place_in_header(column));
    if (!check_name(name, place, root, problems)) continue;
    samples.samples.parameters.emplace_back(name);
    samples.columns.push_back(place);
    if (auto with = manifest_text::with_value(changed, name, choice_of(samples, *read_in, column, place),
                                              place, problems))
      changed = std::move(with);
  }
  root = std::move(changed);
}

void join_samples(const SamplesTable& table, const std::vector<SweptAxis>& axes, keys::StudyDraft& draft) {
  std::vector<std::uint32_t> slots;
  for (const std::string& name : table.samples.parameters) {
    const auto range = study::find_slots(name, draft.plan.table);
    if (!range || draft.plan.base[range->first].kind != study::Value::Kind::distribution)
      return;  // reported where it was read
    slots.push_back(static_cast<std::uint32_t>(range->first));
  }
  if (slots.empty()) return;  // the table could not be read, which is reported
  if (!check_not_swept(table, slots, axes, draft) || !check_draw_levels(table, slots, draft)) return;
  draft.study.samples = table.samples;
  draft.study.samples->level = draft.plan.base[slots.front()].level;
  draft.plan.sampled_slots = std::move(slots);
}

}  // namespace zerocount::sections

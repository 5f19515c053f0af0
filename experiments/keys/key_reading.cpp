#include "experiments/keys/key_reading.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::keys {
namespace {

void set_none(const GeneralKey& key, Reading& reading) {
  if (key.set) key.set(reading, std::nullopt);
  for (const GeneralKey& part : key.keys) set_none(part, reading);
}

void read_map_of_keys(const yaml::Field& field, const GeneralKey& key, Reading& reading) {
  if (!yaml::check_map(field, std::string(key.example), reading.problems)) return;
  std::vector<std::string> known;
  for (const GeneralKey& part : key.keys) known.emplace_back(part.name);
  parameters::check_keys(field, known, reading.problems);
  read_keys(field, key.keys, reading);
}

/// The value as a number (see GeneralKey::set).
std::optional<double> read_as_number(const yaml::Field& field, const GeneralKey& key, Reading& reading) {
  const auto number = [](const auto& read) {
    return read ? std::optional(static_cast<double>(*read)) : std::nullopt;
  };
  switch (key.form) {
    case GeneralKey::Form::boolean:
      return number(yaml::read_bool(field, reading.problems));
    case GeneralKey::Form::label:
      return number(yaml::read_label(field, key.labels, reading.problems));
    case GeneralKey::Form::whole_number:
      return number(yaml::read_whole(field, static_cast<std::int64_t>(key.range.low),
                                     static_cast<std::int64_t>(key.range.high), reading.problems, key.none));
    case GeneralKey::Form::real:
      return yaml::read_real(field, key.range, reading.problems, key.none);
    case GeneralKey::Form::own:
    case GeneralKey::Form::text:
    case GeneralKey::Form::map:
      break;
  }
  return std::nullopt;
}

}  // namespace

void read_key(const yaml::Field& field, const GeneralKey& key, Reading& reading) {
  const auto is_word = [&](std::string_view word) {
    return field.node->kind == yaml::YamlNode::Kind::scalar && field.node->text == word;
  };
  const auto preset = std::ranges::find_if(key.presets, is_word, [](const auto& one) { return one.first; });
  if (!key.none.empty() && is_word(key.none)) {
    set_none(key, reading);
  } else if (preset != key.presets.end()) {
    preset->second(reading);
  } else if (key.form == GeneralKey::Form::map) {
    read_map_of_keys(field, key, reading);
  } else if (key.text) {
    key.text(reading) = yaml::read_text(field, reading.problems).value_or(key.text(reading));
  } else if (key.set) {
    if (const auto value = read_as_number(field, key, reading)) key.set(reading, value);
  }
}

void read_keys(const yaml::Field& map, std::span<const GeneralKey> keys, Reading& reading) {
  for (const GeneralKey& key : keys) {
    if (const auto field = yaml::find_field(map, key.name)) {
      read_key(*field, key, reading);
    } else if (key.required()) {
      reading.problems.add_missing(
          map.node->place,
          map.path.empty() ? std::string(key.name) : fmt::format("{}.{}", map.path, key.name),
          key.if_missing);
    }
  }
}

std::optional<double> default_of(const GeneralKey& key) {
  if (key.required() || !key.get) return std::nullopt;
  yaml::Problems problems;
  study::StudyPlan plan;
  study::Study study;
  plan.sequence.emplace();
  study.stop.emplace();
  study.goals.emplace_back();
  study.tuning.emplace();
  Reading reading{problems, plan, study};
  const auto value = key.get(reading);
  const bool is_number = key.form == GeneralKey::Form::whole_number || key.form == GeneralKey::Form::real;
  return value && is_number && !numerics::contains(key.range, *value) ? std::nullopt : value;
}

}  // namespace zerocount::keys

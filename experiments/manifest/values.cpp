#include "experiments/manifest/values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/friction/profile_range.hpp"
#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/distributions/random_field.hpp"
#include "experiments/manifest/drawn_per.hpp"

namespace zerocount {
namespace {

constexpr std::string_view profile_name = "profile";

std::string expected_of(const Parameter& parameter, const StudyUnits& units) {
  if (has_labels(parameter)) return fmt::format("one of {}", fmt::join(parameter.labels, ", "));
  const std::string words = in_words(range_of(parameter, units));
  const std::string noun = parameter.kind == ParameterKind::whole_number ? "whole numbers" : "numbers";
  return words.rfind("any", 0) == 0 ? "finite " + noun + " only" : noun + " " + words + " only";
}

Value number_value(double number) {
  return {.kind = Value::Kind::number, .number = number};
}

Value read_truth_value(const Field& field, Problems& problems) {
  const auto truth = read_truth(field, problems);
  return truth ? number_value(*truth ? 1.0 : 0.0) : unreadable_value();
}

Value read_word(const Field& field, const Parameter& parameter, Problems& problems) {
  const YamlNode& node = *field.node;
  const auto word = std::find(parameter.labels.begin(), parameter.labels.end(), node.text);
  if (node.kind == YamlNode::Kind::scalar && word != parameter.labels.end()) {
    return number_value(static_cast<double>(word - parameter.labels.begin()));
  }
  problems.add(node.place, field.path, fmt::format("{} is none of its words", in_quotes(flow_text(node))),
               fmt::format("one of {}", fmt::join(parameter.labels, ", ")));
  return unreadable_value();
}

Value read_number(const Field& field, const Parameter& parameter, Reading& reading) {
  Problems& problems = reading.problems;
  if (parameter.kind == ParameterKind::whole_number) {
    const auto whole = read_whole(field, static_cast<std::int64_t>(parameter.range.low),
                                  static_cast<std::int64_t>(parameter.range.high), problems);
    return whole ? number_value(static_cast<double>(*whole)) : unreadable_value();
  }
  const auto real = read_real(field, range_of(parameter, reading.plan.units), problems);
  return real ? number_value(*real) : unreadable_value();
}

bool check_support(const Field& field, const Parameter& parameter, const Interval& values, Reading& reading) {
  const Interval range = range_of(parameter, reading.plan.units);
  if (contains(range, values)) return true;
  reading.problems.add(
      field.node->place, field.path,
      fmt::format("its values {} leave the range allowed {}", notation(values), notation(range)),
      expected_of(parameter, reading.plan.units));
  return false;
}

Value read_drawn(const DistributionForm& form, const Field& field, const Parameter& parameter,
                 Reading& reading) {
  const auto distribution = read_distribution(form, field, reading.problems);
  if (!distribution || !check_support(field, parameter, support(*distribution), reading)) {
    return unreadable_value();
  }
  if (parameter.kind == ParameterKind::whole_number && !whole_numbers_only(*distribution)) {
    reading.problems.add(field.node->place, field.path, "its values are not whole numbers",
                         "integers, or a choice of whole numbers");
    return unreadable_value();
  }
  if (!extremes_are_inside(*distribution, range_of(parameter, reading.plan.units))) {
    reading.problems.add(field.node->place, field.path,
                         "its extreme values are too large or too small for a double",
                         expected_of(parameter, reading.plan.units));
    return unreadable_value();
  }
  reading.plan.distributions.push_back(*distribution);
  return {.kind = Value::Kind::distribution,
          .index = static_cast<std::uint32_t>(reading.plan.distributions.size() - 1)};
}

Value read_profile_value(const Field& field, std::size_t row, Per per, Reading& reading) {
  constexpr std::size_t max_profiles = 1000;
  if (!reading.plan.period) {
    reading.problems.add(field.node->place, field.path,
                         "the profile of a linear axis needs the key travel, its period",
                         "travel: the length in m after which friction is the same again");
    return unreadable_value();
  }
  const auto form = read_profile(field, *reading.plan.period, reading.problems);
  if (!form) return unreadable_value();
  if (reading.profiles.size() == max_profiles) {
    reading.problems.add(field.node->place, field.path, "there are too many profiles",
                         fmt::format("at most {} in a study", max_profiles));
    return unreadable_value();
  }
  reading.profiles.push_back({row, *form, per, field.node->place, field.path});
  return {.kind = Value::Kind::profile,
          .index = static_cast<std::uint32_t>(reading.profiles.size() - 1),
          .per = per};
}

// The only entry of the map but `per`, or null.
const YamlEntry* form_entry(const YamlNode& map) {
  const auto is_form = [](const YamlEntry& entry) { return entry.key != per_key; };
  if (std::count_if(map.entries.begin(), map.entries.end(), is_form) != 1) return nullptr;
  return &*std::find_if(map.entries.begin(), map.entries.end(), is_form);
}

Value read_map(const Field& field, std::size_t row, Reading& reading) {
  const Parameter& parameter = parameter_table()[row];
  const std::string expected = fmt::format("a map with one of {}, {}; {} may stand beside it",
                                           distribution_names(), profile_name, per_key);
  const YamlEntry* entry = form_entry(*field.node);
  if (entry == nullptr) {
    reading.problems.add(field.node->place, field.path,
                         fmt::format("a map with {} keys stands here", field.node->entries.size()), expected);
    return unreadable_value();
  }
  const Drawn drawn = entry->key == profile_name ? Drawn::profile : Drawn::value;
  if (drawn == Drawn::profile && parameter.profiled == nullptr) {
    reading.problems.add(entry->value->place, entry_of(field, *entry).path,
                         text_on(reading.plan.units.axis, "this parameter does not vary along the rotor"),
                         "a number or a distribution other than profile");
    return unreadable_value();
  }
  Per per = usual_per(parameter, drawn, reading.has_rigs);
  if (const YamlEntry* given = find_entry(*field.node, per_key)) {
    per =
        read_per(entry_of(field, *given), parameter, drawn, reading.has_rigs, reading.problems).value_or(per);
  }
  if (drawn == Drawn::profile) return read_profile_value(entry_of(field, *entry), row, per, reading);
  const DistributionForm* form =
      find_form(field, *entry, {std::string(profile_name)}, expected, reading.problems);
  if (form == nullptr) return unreadable_value();
  Value value = read_drawn(*form, entry_of(field, *entry), parameter, reading);
  value.per = per;
  return value;
}

// Whether the values of the rotor stay in the range, everywhere on it.
bool check_rotor(const ProfileRequest& request, const Rotors& rotors, std::int64_t rotor,
                 const Reading& reading) {
  const Parameter& parameter = parameter_table()[request.row];
  const StudyUnits& units = reading.plan.units;
  const std::shared_ptr<const Profile> profile = rotors.rotor(rotor);
  if (contains(parameter.range, limits(*profile))) return true;  // the quick answer
  const ValueRange values = range_over_revolution(*profile);
  if (contains(parameter.range, closed(values.low, values.high))) return true;
  const std::string of_rig = request.per == Per::rig ? fmt::format(" of rig {}", rotor) : "";
  reading.problems.add(
      request.place, request.path,
      fmt::format("its values {}{}, {:.6g} to {:.6g} with this seed, leave the range allowed {}",
                  text_on(units.axis, "along the rotor"), of_rig, values.low, values.high,
                  notation(parameter.range)),
      expected_of(parameter, units));
  return false;
}

// Reports a parameter that only the other kind of axis has.
bool check_exists(const Field& field, const Parameter& parameter, Reading& reading) {
  const AxisKind axis = reading.plan.units.axis;
  if (exists_on(parameter, axis)) return true;
  reading.problems.add(
      field.node->place, field.path,
      fmt::format("a {} axis does not have it", axis_labels()[static_cast<std::size_t>(axis)]),
      parameter.instead);
  return false;
}

}  // namespace

void check_profiles(const Reading& reading) {
  for (std::size_t i = 0; i < reading.profiles.size(); ++i) {
    const ProfileRequest& request = reading.profiles[i];
    const Rotors& rotors = *reading.plan.profiles[i];
    if (contains(parameter_table()[request.row].range, rotors.bounds())) continue;
    for (std::int64_t rotor = 0; rotor < rotors.count(); ++rotor) {
      if (!check_rotor(request, rotors, rotor, reading)) break;
    }
  }
}

Value unreadable_value() {
  return number_value(std::numeric_limits<double>::quiet_NaN());
}

Value read_value(const Field& field, std::size_t row, Reading& reading) {
  const Parameter& parameter = parameter_table()[row];
  if (!check_exists(field, parameter, reading)) return unreadable_value();
  if (parameter.kind == ParameterKind::truth) return read_truth_value(field, reading.problems);
  if (parameter.kind == ParameterKind::enumeration) return read_word(field, parameter, reading.problems);
  if (field.node->kind == YamlNode::Kind::map) return read_map(field, row, reading);
  return read_number(field, parameter, reading);
}

Value checked_number(const Field& field, std::size_t row, double number, Reading& reading) {
  const Parameter& parameter = parameter_table()[row];
  if (!check_exists(field, parameter, reading)) return unreadable_value();
  const bool fits = parameter.kind == ParameterKind::real ||
                    (parameter.kind == ParameterKind::whole_number && number == std::trunc(number));
  if (fits && contains(range_of(parameter, reading.plan.units), number)) return number_value(number);
  reading.problems.add(field.node->place, field.path, fmt::format("the value {} is not allowed", number),
                       expected_of(parameter, reading.plan.units));
  return unreadable_value();
}

}  // namespace zerocount

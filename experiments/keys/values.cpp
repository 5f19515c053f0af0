#include "experiments/keys/values.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/friction/profile.hpp"
#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/distributions/random_field.hpp"

namespace zerocount::keys {
namespace {

constexpr std::string_view profile_name = "profile";

study::Value number_value(double number) {
  return {.kind = study::Value::Kind::number, .number = number};
}

// Reports a value that cannot be used.
study::Value refuse(StudyDraft& draft, const yaml::Field& field, std::string_view what,
                    std::string_view expected) {
  draft.problems.add(field, what, expected);
  return unreadable_value();
}

study::Value read_bool_value(const yaml::Field& field, yaml::Problems& problems) {
  const auto truth = yaml::read_bool(field, problems);
  return truth ? number_value(*truth ? 1.0 : 0.0) : unreadable_value();
}

study::Value read_enumeration(const yaml::Field& field, const parameters::Parameter& parameter,
                              yaml::Problems& problems) {
  const auto label = yaml::read_label(field, parameter.labels, problems);
  return label ? number_value(static_cast<double>(*label)) : unreadable_value();
}

bool is_none(const yaml::YamlNode& node) {
  return node.kind == yaml::YamlNode::Kind::scalar && node.text == "none";
}

study::Value read_number(const yaml::Field& field, const parameters::Parameter& parameter,
                         StudyDraft& draft) {
  if (parameter.none && is_none(*field.node)) return number_value(*parameter.none);
  yaml::Problems& problems = draft.problems;
  const std::string or_else = number_alternatives(parameter, draft.plan.units);
  if (parameter.kind == parameters::ParameterKind::whole_number) {
    const auto whole = yaml::read_whole(field, static_cast<std::int64_t>(parameter.range.low),
                                        static_cast<std::int64_t>(parameter.range.high), problems, or_else);
    return whole ? number_value(static_cast<double>(*whole)) : unreadable_value();
  }
  const auto real = yaml::read_real(field, parameter.range, problems, or_else);
  return real ? number_value(*real) : unreadable_value();
}

bool check_support(const yaml::Field& field, const parameters::Parameter& parameter,
                   const distributions::Distribution& distribution, StudyDraft& draft) {
  const numerics::Interval values = distributions::support(distribution);
  const numerics::Interval& range = parameter.range;
  if (numerics::contains(range, values)) return true;
  draft.problems.add(field,
                     fmt::format("its values {} exceed the allowed range {}", numerics::notation(values),
                                 numerics::notation(range)),
                     allowed_values(parameter, draft.plan.units) + cure_of_normal(distribution, parameter));
  return false;
}

study::Value read_drawn(const distributions::DistributionForm& form, const yaml::Field& field,
                        const parameters::Parameter& parameter, StudyDraft& draft) {
  const auto distribution = distributions::read_distribution(form, field, draft.problems);
  if (!distribution || !check_support(field, parameter, *distribution, draft)) {
    return unreadable_value();
  }
  if (parameter.kind == parameters::ParameterKind::whole_number &&
      !distributions::whole_numbers_only(*distribution)) {
    return refuse(draft, field, "its values are not whole numbers",
                  form.name == distributions::interval_name
                      ? "integers, or a choice of whole numbers, with per: world"
                      : "integers, or a choice of whole numbers");
  }
  if (!distributions::extremes_are_inside(*distribution, parameter.range)) {
    return refuse(draft, field, "its extreme values are too large or too small for a double",
                  allowed_values(parameter, draft.plan.units));
  }
  draft.plan.distributions.push_back(*distribution);
  return {.kind = study::Value::Kind::distribution,
          .index = static_cast<std::uint32_t>(draft.plan.distributions.size() - 1)};
}

study::Value read_profile_value(const yaml::Field& field, std::size_t slot, study::DrawLevel level,
                                StudyDraft& draft) {
  constexpr std::size_t max_profiles = 1000;
  if (!draft.plan.period) {
    return refuse(draft, field, "the profile of a linear axis needs the key travel, its period",
                  "travel: the length in m after which friction is the same again");
  }
  const auto form = distributions::read_profile(field, *draft.plan.period, draft.problems);
  if (!form) return unreadable_value();
  if (draft.profiles.size() == max_profiles) {
    return refuse(draft, field, "there are too many profiles",
                  fmt::format("at most {} in a study", max_profiles));
  }
  draft.profiles.push_back({slot, *form, level, field.node->place, field.path});
  return {.kind = study::Value::Kind::profile,
          .index = static_cast<std::uint32_t>(draft.profiles.size() - 1),
          .level = level};
}

// The only entry of the map besides `per` and `aging`, or null.
const yaml::YamlEntry* form_entry(const yaml::YamlNode& map) {
  const auto is_form = [](const yaml::YamlEntry& entry) {
    return entry.key != per_key && entry.key != aging_key;
  };
  if (std::count_if(map.entries.begin(), map.entries.end(), is_form) != 1) return nullptr;
  return &*std::find_if(map.entries.begin(), map.entries.end(), is_form);
}

// A number with `aging` beside it.
study::Value read_constant(const yaml::Field& field, const parameters::Parameter& parameter,
                           StudyDraft& draft) {
  if (const auto per = yaml::find_field(field, per_key))
    return refuse(draft, *per, "a number is not drawn", "a distribution, or the key left out");
  if (!yaml::find_field(field, aging_key))
    return refuse(draft, field, fmt::format("{} is for a number that changes with age", value_key),
                  fmt::format("the number alone, or {} beside it", aging_key));
  return read_number(yaml::find_field(field, value_key).value(), parameter, draft);
}

study::Value read_form(const yaml::Field& field, std::size_t slot, StudyDraft& draft) {
  const parameters::Parameter& parameter = draft.plan.table.rows[slot];
  const std::string expected =
      fmt::format("a map with one of {}, {}; {} and {} may stand beside it",
                  distributions::distribution_names(), profile_name, per_key, aging_key);
  const yaml::YamlEntry* entry = form_entry(*field.node);
  if (entry == nullptr) {
    return refuse(draft, field, fmt::format("found a map with {} keys", field.node->entries.size()),
                  expected);
  }
  if (entry->key == value_key) return read_constant(field, parameter, draft);
  const Drawn drawn = entry->key == profile_name                   ? Drawn::profile
                      : entry->key == distributions::interval_name ? Drawn::interval
                                                                   : Drawn::value;
  if (drawn == Drawn::profile && parameter.profiled == nullptr) {
    draft.problems.add(
        entry->value->place, yaml::entry_of(field, *entry).path,
        parameters::text_on(draft.plan.units.axis, "this parameter cannot vary along the $track"),
        "a number or a distribution other than profile");
    return unreadable_value();
  }
  study::DrawLevel level = usual_level(parameter, drawn, draft.groups);
  if (const auto given = yaml::find_field(field, per_key)) {
    level = read_draw_level(*given, parameter, drawn, draft.groups, draft.problems).value_or(level);
  } else if (drawn == Drawn::interval && !draft.groups.worlds) {
    return refuse(draft, field,
                  "a value without a distribution is drawn for each world, and the study has none",
                  "the key worlds, or uniform in place of interval");
  }
  if (drawn == Drawn::profile) return read_profile_value(yaml::entry_of(field, *entry), slot, level, draft);
  const distributions::DistributionForm* form =
      distributions::find_form(field, *entry, {std::string(profile_name)}, expected, draft.problems);
  if (form == nullptr) return unreadable_value();
  study::Value value = read_drawn(*form, yaml::entry_of(field, *entry), parameter, draft);
  value.level = level;
  return value;
}

study::Value read_map(const yaml::Field& field, std::size_t slot, StudyDraft& draft) {
  study::Value value = read_form(field, slot, draft);
  if (const auto aging = yaml::find_field(field, aging_key)) read_aging(*aging, slot, value, draft);
  return value;
}

// Whether the parameter stays in its range everywhere on the rotor.
bool check_rotor(const ProfileRequest& request, const study::Rotors& rotors, std::int64_t rotor,
                 const StudyDraft& draft) {
  const parameters::Parameter& parameter = draft.plan.table.rows[request.slot];
  const parameters::StudyUnits& units = draft.plan.units;
  const std::shared_ptr<const friction::Profile> profile = rotors.rotor(rotor);
  if (numerics::contains(parameter.range, distributions::limits(*profile)))
    return true;  // a fast sufficient test
  const friction::ValueRange values = friction::range_over_revolution(*profile);
  if (numerics::contains(parameter.range, numerics::closed(values.low, values.high))) return true;
  const std::string of_machine =
      request.level == study::DrawLevel::machine ? fmt::format(" of machine {}", rotor) : "";
  draft.problems.add(
      request.place, request.path,
      fmt::format("its values {}{}, {:.6g} to {:.6g} with this seed, exceed the allowed range {}",
                  parameters::text_on(units.axis, "along the $track"), of_machine, values.low, values.high,
                  numerics::notation(parameter.range)),
      allowed_values(parameter, units));
  return false;
}

// Reports a parameter that exists only on the other kind of axis.
bool check_exists(const yaml::Field& field, const parameters::Parameter& parameter, StudyDraft& draft) {
  const parameters::AxisKind axis = draft.plan.units.axis;
  if (parameters::exists_on(parameter, axis)) return true;
  draft.problems.add(
      field,
      fmt::format("not available on a {} axis", parameters::axis_labels[static_cast<std::size_t>(axis)]),
      parameter.instead);
  return false;
}

}  // namespace

void check_profiles(const StudyDraft& draft) {
  for (std::size_t i = 0; i < draft.profiles.size(); ++i) {
    const ProfileRequest& request = draft.profiles[i];
    const study::Rotors& rotors = *draft.plan.profiles[i];
    if (numerics::contains(draft.plan.table.rows[request.slot].range, rotors.bounds())) continue;
    for (std::int64_t rotor = 0; rotor < rotors.count(); ++rotor) {
      if (!check_rotor(request, rotors, rotor, draft)) break;
    }
  }
}

study::Value unreadable_value() {
  return number_value(std::numeric_limits<double>::quiet_NaN());
}

study::Value read_value(const yaml::Field& field, std::size_t slot, StudyDraft& draft) {
  const parameters::Parameter& parameter = draft.plan.table.rows[slot];
  draft.rate.reset();
  if (!check_exists(field, parameter, draft)) return unreadable_value();
  if (parameter.kind == parameters::ParameterKind::boolean) return read_bool_value(field, draft.problems);
  if (parameter.kind == parameters::ParameterKind::enumeration)
    return read_enumeration(field, parameter, draft.problems);
  if (field.node->kind == yaml::YamlNode::Kind::map) return read_map(field, slot, draft);
  return read_number(field, parameter, draft);
}

study::Value checked_number(const yaml::Field& field, std::size_t slot, double number, StudyDraft& draft) {
  const parameters::Parameter& parameter = draft.plan.table.rows[slot];
  if (!check_exists(field, parameter, draft)) return unreadable_value();
  const bool fits =
      parameter.kind == parameters::ParameterKind::real ||
      (parameter.kind == parameters::ParameterKind::whole_number && number == std::trunc(number));
  if (fits && numerics::contains(parameter.range, number)) return number_value(number);
  return refuse(draft, field, fmt::format("the value {} is not allowed", number),
                allowed_values(parameter, draft.plan.units));
}

}  // namespace zerocount::keys

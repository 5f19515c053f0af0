#include "experiments/sections/ages.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/unknown_key.hpp"
#include "experiments/study/condition_study.hpp"

namespace zerocount::sections {
namespace {

constexpr std::size_t max_ages = 1000;
constexpr std::size_t max_turns = 10'000;
constexpr std::string_view expected_ages = "ages: {at: [0, 1.0e+5, 1.0e+6], unit: cycles}";

/// Rising ages; empty, after a report, if there are none.
std::vector<double> read_at(const yaml::Field& list, yaml::Problems& problems) {
  const std::string expected = fmt::format("a rising list of 1 to {} ages from 0 on", max_ages);
  if (!yaml::check_list(list, expected, problems)) return {};
  std::vector<double> at;
  for (std::size_t i = 0; i < list.node->items.size(); ++i) {
    const auto age = yaml::read_real(yaml::item_of(list, i), numerics::at_least(0), problems);
    if (!age) return {};
    at.push_back(*age);
  }
  if (at.empty() || at.size() > max_ages) {
    problems.add(list, fmt::format("found {} ages", at.size()), expected);
    return {};
  }
  if (std::ranges::adjacent_find(at, std::greater_equal<>()) != at.end()) {
    problems.add(list, "the ages do not rise", expected);
    return {};
  }
  return at;
}

void read_unit(const yaml::Field& field, study::Ages& ages, yaml::Problems& problems) {
  const auto unit = yaml::read_line(field, problems);
  if (!unit) return;
  if (unit->empty() || unit->find_first_of(" \t\r\n") != std::string::npos) {
    problems.add(field, "the unit of ages is not one word", "a word such as cycles, h or km");
    return;
  }
  ages.unit = *unit;
}

}  // namespace

void read_ages(const yaml::Field& root, keys::Reading& reading) {
  const auto field = yaml::find_field(root, "ages");
  if (!field || !yaml::check_map(*field, std::string(expected_ages), reading.problems)) return;
  parameters::check_keys(*field, std::vector<std::string>{"at", "unit"}, reading.problems);
  study::Ages& ages = reading.study.ages;
  if (const auto unit = yaml::find_field(*field, "unit")) read_unit(*unit, ages, reading.problems);
  if (const auto at = yaml::find_field(*field, "at")) {
    ages.at = read_at(*at, reading.problems);
  } else {
    reading.problems.add_missing(field->node->place, "ages.at", "a rising list of ages: at: [0, 1.0e+5]");
  }
  if (!reading.groups.rigs)
    reading.problems.add(*field, "only machines have ages: the study has none",
                         "the key rigs, such as rigs: 100");
  reading.plan.ages = ages.at;
}

SweptAxis conditions_at_ages(const SweptAxis& conditions, keys::Reading& reading) {
  const study::Ages& ages = reading.study.ages;
  SweptAxis turns{.name = "condition", .place = conditions.place};
  const std::size_t of_age = std::max<std::size_t>(conditions.labels.size(), 1);
  if (of_age > max_turns / std::max<std::size_t>(ages.at.size(), 1)) {
    reading.problems.add(conditions.place, "conditions",
                         fmt::format("{} conditions at {} ages are too many", of_age, ages.at.size()),
                         fmt::format("at most {} of both together", max_turns));
    return turns;
  }
  if (ages.at.empty()) {
    turns = conditions;
  } else {
    for (const double age : ages.at) {
      if (conditions.labels.empty()) finish_option(turns, study::age_text(ages, age));
      for (std::size_t c = 0; c < conditions.labels.size(); ++c) {
        for (std::size_t i = conditions.axis.first[c]; i < conditions.axis.first[c + 1]; ++i) {
          turns.axis.assignments.push_back(conditions.axis.assignments[i]);
          turns.places.push_back(conditions.places[i]);
        }
        finish_option(turns, study::label_under(conditions.labels[c], study::age_text(ages, age)));
      }
    }
  }
  reading.study.conditions = turns.labels;
  return turns;
}

}  // namespace zerocount::sections

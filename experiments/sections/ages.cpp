#include "experiments/sections/ages.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/study/condition_study.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::sections {
namespace {

constexpr std::size_t max_turns = 10'000;
}  // namespace

void read_ages(const yaml::Field& root, keys::Reading& reading) {
  const auto field = yaml::find_field(root, "ages");
  if (!field) return;
  shapes::read(*field, keys::shape_of("ages"), reading.problems, &reading);
  reading.plan.ages = reading.study.ages.at;
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

#include <cstdint>

#include <fmt/format.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::sections {
namespace {

constexpr std::int64_t max_settings = 10'000;

/// Copies the assignments of one option of the axis `from` to the last option of the axis `to`, which is not
/// finished yet.
void copy_option(const SweptAxis& from, std::size_t option, SweptAxis& to) {
  for (std::size_t i = from.axis.first[option]; i < from.axis.first[option + 1]; ++i) {
    to.axis.assignments.push_back(from.axis.assignments[i]);
    to.places.push_back(from.places[i]);
  }
}

}  // namespace

void read_ages(const yaml::Field& root, keys::StudyDraft& draft) {
  const auto field = yaml::find_field(root, "ages");
  if (!field) return;
  shapes::read(*field, keys::shape_of("ages"), draft.problems, &draft);
  draft.plan.ages = draft.study.settings.ages.at;
}

SweptAxis settings_axis(const SweptAxis& conditions, keys::StudyDraft& draft) {
  study::Settings& settings = draft.study.settings;
  SweptAxis axis{.name = "condition", .place = conditions.place};
  const study::SettingCounts counts = settings.counts();
  if (counts.conditions > max_settings / counts.ages) {
    draft.problems.add(conditions.place, "conditions",
                       fmt::format("{} conditions at {} ages are too many", counts.conditions, counts.ages),
                       fmt::format("at most {} of both together", max_settings));
    settings.conditions.clear();
    settings.ages.at.clear();
  }
  if (settings.empty()) return axis;
  for (std::int64_t index = 0; index < counts.total(); ++index) {
    if (!conditions.labels.empty())
      copy_option(conditions, static_cast<std::size_t>(settings.at(index).condition), axis);
    finish_option(axis, study::label_of(settings, index));
  }
  return axis;
}

}  // namespace zerocount::sections

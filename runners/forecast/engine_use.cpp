#include "runners/forecast/engine_use.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/batch/batch.hpp"

namespace zerocount::forecast {

PointsOnReference points_on_reference(const study::Study& study) {
  constexpr std::int64_t max_points = 1000;
  PointsOnReference use;
  if (study.engine == study::Engine::reference) return use;  // as asked for
  const study::TrialTurns turns = study::turns_of(study);
  use.examined = std::min(study::point_count(study), max_points);
  for (std::int64_t point = 0; point < use.examined; ++point) {
    bool lacking = false;
    for (std::int64_t condition = 0; condition < turns.conditions; ++condition) {
      const std::string feature =
          batch::lacking_in_lanes(study::study_trial(study, point, turns.trial_of(0, condition)).parameters);
      if (feature.empty()) continue;
      lacking = true;
      if (std::find(use.features.begin(), use.features.end(), feature) == use.features.end())
        use.features.push_back(feature);
    }
    use.points += lacking;
  }
  return use;
}

std::string engine_text(const PointsOnReference& use) {
  if (use.points == 0) return "";
  const std::string points =
      use.points == use.examined ? "all trials" : fmt::format("{} of {} points", use.points, use.examined);
  return fmt::format("{} run on the reference engine, about ten times slower, because of {}", points,
                     fmt::join(use.features, ", "));
}

}  // namespace zerocount::forecast

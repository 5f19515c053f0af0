#include "runners/tuning/worst_machines/machine_race.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "runners/trials/trial_set.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::size_t stages = stage_trials.size();
constexpr std::size_t race_part = 4;  // one of so many goes on to the next stage
constexpr std::int64_t raced_at_once = 64;

/// Runs the trials of a stage.
void simulate(std::vector<BoxPoint>& points, std::size_t stage, const MachineBox& box,
              const MachineFailures& failures, const trials::Effort& effort) {
  const std::int64_t from = stage == 0 ? 0 : stage_trials[stage - 1];
  const auto trials = static_cast<std::size_t>(stage_trials[stage] - from);
  for (BoxPoint& point : points)
    point.results.push_back(stage == 0 ? ClaimResult{} : ClaimResult(point.results.back()));
  const std::size_t size = (raced_at_once + trials - 1) / trials;
  const auto points_of = [&](std::size_t block) {
    return std::span(points).subspan(block * size, std::min(size, points.size() - block * size));
  };
  const auto draw = [&](std::size_t block) {
    std::vector<trial::TrialParameters> drawn;
    for (const BoxPoint& point : points_of(block)) {
      for (std::int64_t i = from; i < stage_trials[stage]; ++i)
        drawn.push_back(box.trial_of(point, box.study().trials + i));
    }
    return drawn;
  };
  trials::run({static_cast<std::int64_t>(points.size() * trials), (points.size() + size - 1) / size, draw},
              effort, [&](std::size_t block, std::span<const trial::TrialOutcome> outcomes) {
                for (BoxPoint& point : points_of(block)) {
                  failures.add_to(point.results.back(), outcomes.first(trials));
                  outcomes = outcomes.subspan(trials);
                }
              });
}

/// The worst first.
void sort_by(std::vector<BoxPoint>& points, std::size_t stage, const MachineFailures& failures) {
  std::ranges::stable_sort(points, [&](const BoxPoint& a, const BoxPoint& b) {
    return failures.is_worse(a.results[stage], b.results[stage]);
  });
}

}  // namespace

void race(std::vector<BoxPoint>& points, const MachineBox& box, const MachineFailures& failures,
          const trials::Effort& effort) {
  const auto newcomers = std::stable_partition(
      points.begin(), points.end(), [](const BoxPoint& point) { return point.results.size() == stages; });
  std::vector<BoxPoint> running(newcomers, points.end());
  points.erase(newcomers, points.end());
  for (std::size_t stage = 0; stage < stages; ++stage) {
    simulate(running, stage, box, failures, effort);
    sort_by(running, stage, failures);
    const std::size_t on = std::max((running.size() + race_part - 1) / race_part, survivors / 2);
    if (stage + 1 == stages) break;
    if (running.size() > on) running.resize(on);
    if (points.size() < survivors) continue;
    std::erase_if(running, [&](const BoxPoint& point) {
      return !failures.is_worse(point.results[stage], points.back().results[stage]);
    });
  }
  std::ranges::move(running, std::back_inserter(points));
  sort_by(points, stages - 1, failures);
  if (points.size() > survivors) points.resize(survivors);
}

}  // namespace zerocount::tuning

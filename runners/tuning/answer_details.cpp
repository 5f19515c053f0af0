#include "runners/tuning/answer_details.hpp"

#include <cmath>
#include <optional>

#include "analysis/measures/goal_counts.hpp"
#include "core/numerics/bisection.hpp"
#include "runners/tuning/limits.hpp"

namespace zerocount::tuning {
namespace {

bool seems_met(const TunedStudy& tuned, const study::Study& study, const Change* change) {
  return rate_of(study, tuned.units, tuned.count, change, tuned.effort) >= wanted_rate(aim_of(study));
}

/// The last place from `kept` towards `lost` where the condition still holds, to 2^−halvings of the way.
template <class Condition>
double last_kept(double kept, double lost, int halvings, const Condition& holds) {
  return numerics::bisect({kept, lost}, holds, numerics::after_halvings(halvings)).holds;
}

}  // namespace

std::optional<double> delay_lost(const TunedStudy& tuned, double delay) {
  const auto holds = [&](double at) {
    const Change later = [&](trial::TrialParameters& p) { p.controller.delay += at - delay; };
    return seems_met(tuned, tuned.study, &later);
  };
  constexpr double step = 0.25;
  constexpr double most = 5.0;
  for (double more = step; more <= most; more += step) {
    if (!holds(delay + more)) return last_kept(delay + more - step, delay + more, 3, holds);
  }
  return std::nullopt;
}

std::optional<double> rate_in_wider_band(const TunedStudy& tuned) {
  const std::optional<std::size_t> wanted = measures::asked_of_moves(tuned.study).front().slot;
  if (!wanted) return std::nullopt;  // the goal is a tolerance
  const std::size_t slot = *wanted;
  const Change wider = [slot](trial::TrialParameters& p) {
    for (std::size_t b = slot; b < p.verdict.bands.count; ++b) ++p.verdict.bands.limits[b];
  };
  return rate_of(tuned.study, tuned.units, tuned.count, &wider, tuned.effort);
}

std::vector<Room> room_of(const TunedStudy& tuned) {
  const UnitCubePoint place = place_of(tuned.free, tuned.gains);
  std::vector<Room> room;
  for (std::size_t i = 0; i < tuned.free.size(); ++i) {
    const auto values = [&](double share) {
      UnitCubePoint moved = place;
      moved[i] = share;
      Values at = tuned.gains;
      at[i] = values_at(tuned.free, moved)[i];
      return at;
    };
    const auto holds = [&](double share) {
      const std::optional<study::Study> study = at_values(tuned.study, tuned.free, values(share));
      return study && seems_met(tuned, *study, nullptr);
    };
    // Outwards in steps, because the goal may be lost and met again farther off.
    const auto end = [&](double to) {
      constexpr int steps = 8;
      double kept = place[i];
      for (int step = 1; step <= steps; ++step) {
        const double next = place[i] + (to - place[i]) * step / steps;
        if (!holds(next)) return last_kept(kept, next, 4, holds);
        kept = next;
      }
      return to;
    };
    room.push_back({tuned.free[i].name, values(end(0.0))[i], values(end(1.0))[i]});
  }
  return room;
}

}  // namespace zerocount::tuning

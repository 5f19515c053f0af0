#include "runners/tuning/answer_details.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "analysis/measures/goal_counts.hpp"
#include "core/numerics/bisection.hpp"
#include "runners/tuning/effects/limits.hpp"

namespace zerocount::tuning {
namespace {

/// Whether the goals seem met; remembers the worst claim where they do not.
class SeemsMet {
 public:
  explicit SeemsMet(const TunedStudy& tuned) : tuned_(tuned), aim_(aim_of(tuned.study)) {}

  bool operator()(const study::Study& study, const Change* change) {
    const Estimate estimate = estimate_on(study, tuned_.units, tuned_.count, change, tuned_.effort);
    const bool met = reaches(aim_, estimate);
    if (!met) lost_ = estimate.worst;
    return met;
  }

  std::optional<std::size_t> lost() const { return lost_; }

 private:
  const TunedStudy& tuned_;
  Aim aim_;
  std::optional<std::size_t> lost_;  ///< by the last study that did not meet them
};

/// The last place from `kept` towards `lost` where the condition still holds, to 2^−halvings of the way.
template <class Condition>
double last_kept(double kept, double lost, int halvings, const Condition& holds) {
  return numerics::bisect({kept, lost}, holds, numerics::after_halvings(halvings)).holds;
}

}  // namespace

std::optional<DelayLost> delay_lost(const TunedStudy& tuned) {
  SeemsMet seems_met(tuned);
  const auto holds = [&](double more) {
    const Change later = [&](trial::TrialParameters& p) { p.controller.delay += more; };
    return seems_met(tuned.study, &later);
  };
  constexpr double most = 5.0;
  constexpr double accuracy = 1.0 / 32.0;
  double kept = 0.0;
  for (double more = 0.25; holds(more); more = std::min(2.0 * more, most)) {
    if (more == most) return std::nullopt;
    kept = more;
  }
  const double lost = kept == 0.0 ? 0.25 : std::min(2.0 * kept, most);
  return DelayLost{numerics::bisect({kept, lost}, holds, numerics::within(accuracy)).holds,
                   seems_met.lost().value()};
}

std::optional<double> rate_in_wider_band(const TunedStudy& tuned, std::size_t goal) {
  const std::optional<std::size_t> wanted = measures::asked_of_moves(tuned.study).at(goal).slot;
  if (!wanted) return std::nullopt;  // the goal is a tolerance
  const std::size_t slot = *wanted;
  const Change wider = [slot](trial::TrialParameters& p) {
    for (std::size_t b = slot; b < p.verdict.bands.count; ++b) ++p.verdict.bands.limits[b];
  };
  const Estimate estimate = estimate_on(tuned.study, tuned.units, tuned.count, &wider, tuned.effort);
  const std::size_t conditions = aim_of(tuned.study).conditions;
  return std::ranges::min(std::span(estimate.rates).subspan(goal * conditions, conditions));
}

std::vector<Room> room_of(const TunedStudy& tuned) {
  const UnitCubePoint place = place_of(tuned.free, tuned.gains);
  SeemsMet seems_met(tuned);
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
      return study && seems_met(*study, nullptr);
    };
    // Outwards in steps, because the goal may be lost and met again farther off.
    const auto end = [&](double to, std::optional<std::size_t>& lost) {
      constexpr int steps = 8;
      double kept = place[i];
      for (int step = 1; step <= steps; ++step) {
        const double next = place[i] + (to - place[i]) * step / steps;
        if (!holds(next)) {
          const double last = last_kept(kept, next, 4, holds);
          lost = seems_met.lost();
          return last;
        }
        kept = next;
      }
      return to;
    };
    Room one{.name = tuned.free[i].name};
    one.low = values(end(0.0, one.lost_below))[i];
    one.high = values(end(1.0, one.lost_above))[i];
    room.push_back(std::move(one));
  }
  return room;
}

}  // namespace zerocount::tuning

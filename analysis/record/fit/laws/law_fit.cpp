#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/observations.hpp"
#include "core/friction/law.hpp"

namespace zerocount::fit {
namespace {

/// Maximum number of steps of a fit that is continued to its end.
constexpr int last_steps = 60;

/// Maximum number of steps for a law that fits so badly that it cannot win (see `hopeless`).
constexpr int hopeless_steps = 15;

FitSetting setting_of(const FitModel& model) {
  return {.model = model, .free = model.free, .prior = {}};
}

FitSetting without_time_offset(FitSetting setting) {
  setting.free.back() = false;
  return setting;
}

FitSetting with_steps(FitSetting setting, int steps) {
  setting.max_steps = steps;
  return setting;
}

/// Random starting points about `centres`, which are taken in turn. Of the free coordinates except the time
/// offset, about half move far, the others little. Most coordinates are logarithms of a parameter. If the
/// slow parts of the records have fixed the stiffness, such points try other orders of magnitude of inertia
/// and damping.
std::vector<Point> scattered(const FitModel& model, const std::vector<Point>& centres) {
  constexpr std::size_t points = 96;
  constexpr double near = 0.1;
  constexpr double far = 2.5;
  std::vector<Point> found;
  for (std::size_t i = 0; i < points; ++i) {
    Point point = centres[i % centres.size()];
    ReplicateNoise random(i);
    for (Eigen::Index j = 0; j + 1 < point.size(); ++j) {
      const double moved = random.next();
      const double spread = random.next() > 0.0 ? far : near;
      if (model.free[static_cast<std::size_t>(j)]) point[j] += spread * moved;
    }
    found.push_back(point);
  }
  return found;
}

/// Rounds of a search from scattered starting points: {number of points, steps for each} per round.
constexpr SearchRounds wide_search{{12, 3}, {6, 4}};

/// The best of short fits from the law's starting points; if none of these points can be simulated, from
/// random points about them.
std::vector<FitResult> first_minima(Records records, const FitModel& model, const Observations& readings,
                                    const FitSetting& setting) {
  std::vector<FitResult> minima = promising_fits(records, readings, model.starts, setting);
  if (minima.empty())
    minima = promising_fits(records, readings, scattered(model, model.starts), setting, wide_search);
  if (!minima.empty()) return minima;
  refuse(
      records.front().axis, records.front().name,
      fmt::format("no starting point of the friction model {} can be simulated along the records, the rotor "
                  "is too fast for their sampling; are the units right?",
                  friction::traits_of(model.law).word));
}

/// The fit of the law to all readings, started from `minima` (results of short fits). The time offset is free
/// only in the last steps, because far from a minimum it would compensate for a wrong inertia.
/// @param least_squares smallest sum of squares of the laws fitted before
FitResult fit_all_readings(Records records, const FitModel& model, const Observations& readings,
                           std::vector<FitResult> minima, double least_squares) {
  const FitSetting setting = setting_of(model);
  const FitSetting undelayed = without_time_offset(setting);
  if (minima.front().squares > hopeless * least_squares) {
    return fit_from(records, readings, minima.front().point, with_steps(setting, hopeless_steps));
  }
  FitResult found = minima.front();
  minima = follow_best(records, readings, std::move(minima), undelayed, {{3, 20}, {1, last_steps}});
  if (!minima.empty()) found = minima.front();
  const FitResult delayed = fit_from(records, readings, found.point, with_steps(setting, last_steps));
  return std::isfinite(delayed.squares) ? delayed : found;
}

/// The fit to observations with independent errors (observe()), starting from a fit to all readings. If that
/// fit leaves residuals above the rounding of the readings, it is returned unchanged: the law causes them,
/// and observations would take most of the time.
/// @param rough the fit to all readings
LawFit refined(Records records, const FitModel& model, const FitResult& rough) {
  LawFit fit;
  fit.setting = setting_of(model);
  fit.squares = rough.squares;
  fit.converged = rough.converged;
  observe_at(records, rough.point, fit);
  bool explained = true;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd& path = fit.model.motions[r].path;
    explained = explained && is_explained(records[r], path);
    const Eigen::VectorXd left = residuals_along(records[r], path);
    std::vector<double>& used = fit.residuals.emplace_back();
    for (std::size_t k = 0; k < sample_count(records[r]); ++k) {
      if (!is_excluded(records[r], k)) used.push_back(left[static_cast<Eigen::Index>(k)]);
    }
  }
  constexpr int rounds = 3;
  constexpr int steps = 15;
  for (int round = 0; explained && round < rounds; ++round) {
    const FitResult finer =
        fit_from(records, fit.observations, fit.model.point, with_steps(fit.setting, steps));
    if (!std::isfinite(finer.squares)) break;
    observe_at(records, finer.point, fit);
  }
  fit.setting.prior = fit.model.point.axis;
  return fit;
}

}  // namespace

LawFit fit_law(Records records, const FitModel& model, double least_squares) {
  const Observations readings = all_readings(records);
  std::vector<FitResult> minima =
      first_minima(records, model, readings, without_time_offset(setting_of(model)));
  return refined(records, model,
                 fit_all_readings(records, model, readings, std::move(minima), least_squares));
}

LawFit search_again(Records records, const FitModel& model, double least_squares, LawFit found) {
  const Observations readings = all_readings(records);
  const FitSetting setting = without_time_offset(setting_of(model));
  std::vector<FitResult> minima;
  for (const std::vector<Point>& centres : {std::vector{found.model.point.axis}, model.starts}) {
    for (const FitResult& fit :
         promising_fits(records, readings, scattered(model, centres), setting, wide_search))
      minima.push_back(fit);
  }
  std::ranges::sort(minima, {}, &FitResult::squares);
  if (minima.empty() || minima.front().squares > hopeless * least_squares) return found;
  const FitResult best = fit_all_readings(records, model, readings, std::move(minima), least_squares);
  return best.squares < found.squares ? refined(records, model, best) : std::move(found);
}

}  // namespace zerocount::fit

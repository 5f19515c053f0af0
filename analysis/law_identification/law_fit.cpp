#include "analysis/law_identification/law_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "analysis/record_fit/encoder_noise.hpp"
#include "core/failure/failure.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {
namespace {

using record_fit::FitResult;
using record_fit::FitSetting;
using record_fit::Observations;

/// Steps of a fit that is continued to its end.
constexpr int last_steps = 60;

/// Steps that a hopeless law still takes.
constexpr int hopeless_steps = 15;

/// True if the readings are counts and the residuals are about those of their rounding.
bool is_explained(Records records, const FitResult& minimum, const Observations& readings) {
  if (!std::all_of(records.begin(), records.end(), [](const TestRecord& record) { return record.counted; })) {
    return false;
  }
  constexpr double tolerated = 1.2;
  std::size_t count = 0;
  for (const std::vector<record_fit::AngleObservation>& of_record : readings) count += of_record.size();
  return minimum.squares < tolerated * static_cast<double>(count);
}

FitSetting setting_of(const LawModel& model) {
  FitSetting setting;
  setting.model = model.axis;
  setting.free = model.free;
  return setting;
}

FitSetting without_time_offset(FitSetting setting) {
  setting.free.back() = false;
  return setting;
}

FitSetting with_steps(FitSetting setting, int steps) {
  setting.max_steps = steps;
  return setting;
}

/// The minimum, or a smaller one that is found from its neighbours.
FitResult with_neighbours(Records records, const LawModel& model, const Observations& readings,
                          const FitSetting& setting, FitResult best) {
  if (!model.neighbours) return best;
  constexpr int rounds = 4;
  constexpr double better = 0.98;
  for (int round = 0; round < rounds && !is_explained(records, best, readings); ++round) {
    const std::vector<FitResult> tried =
        promising_fits(records, readings, model.neighbours(best.point.axis), setting, {3, 8, 1});
    if (tried.empty() || !(tried.front().squares < better * best.squares)) break;
    best = fit_from(records, readings, tried.front().point, with_steps(setting, last_steps));
  }
  return best;
}

/// Points about `centres`, in turns: of the free coordinates but the time offset about half move far at
/// random, the others little. Most are logarithms of a parameter. Where the slow parts of the records have
/// fixed the stiffness, such points try inertia and damping of other orders of magnitude beside it.
std::vector<LawPoint> scattered(const LawModel& model, const std::vector<LawPoint>& centres) {
  constexpr std::size_t points = 96;
  constexpr double near = 0.1;
  constexpr double far = 2.5;
  std::vector<LawPoint> found;
  for (std::size_t i = 0; i < points; ++i) {
    LawPoint point = centres[i % centres.size()];
    record_fit::ReplicateNoise random(i);
    for (Eigen::Index j = 0; j + 1 < point.size(); ++j) {
      const double moved = random.next();
      const double spread = random.next() > 0.0 ? far : near;
      if (model.free[static_cast<std::size_t>(j)]) point[j] += spread * moved;
    }
    found.push_back(point);
  }
  return found;
}

/// How many of the scattered points are followed.
constexpr record_fit::SearchWidth wide_search{12, 12, 3};

/// The best fits from the law's starting points, or from points scattered about them where none of those can
/// be simulated.
std::vector<FitResult> first_minima(Records records, const LawModel& model, const Observations& readings,
                                    const FitSetting& setting) {
  std::vector<FitResult> minima = promising_fits(records, readings, model.starts, setting);
  if (minima.empty())
    minima = promising_fits(records, readings, scattered(model, model.starts), setting, wide_search);
  if (!minima.empty()) return minima;
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: no starting point of the friction model {} can be simulated along the records, "
                  "the rotor is too fast for their sampling; are the units right?",
                  records.front().name, friction::traits_of(model.law).word));
}

/// The fit to all readings from `minima`. The time offset is left free in the last steps only: far from a
/// minimum it would make up for a wrong inertia.
FitResult fit_all_readings(Records records, const LawModel& model, const Observations& readings,
                           std::vector<FitResult> minima, double least_squares) {
  const FitSetting setting = setting_of(model);
  const FitSetting undelayed = without_time_offset(setting);
  if (minima.front().squares > hopeless * least_squares) {
    return fit_from(records, readings, minima.front().point, with_steps(setting, hopeless_steps));
  }
  minima = fits_from(records, readings, std::move(minima), with_steps(undelayed, last_steps));
  const FitResult found = with_neighbours(records, model, readings, undelayed, minima.front());
  const FitResult delayed = fit_from(records, readings, found.point, with_steps(setting, last_steps));
  return std::isfinite(delayed.squares) ? delayed : found;
}

/// Computes the motions and the observations at a point.
void observe_at(Records records, const record_fit::FitPoint& at, LawFit& fit) {
  fit.model = record_fit::model_at(records, at, fit.setting);
  fit.noise = record_fit::noise_along(records, fit.model);
  fit.observations = record_fit::observations_along(records, fit.model, fit.noise);
}

/// The fit to the observations, from a fit to all readings.
LawFit refined(Records records, const LawModel& model, const FitResult& rough) {
  LawFit fit;
  fit.setting = setting_of(model);
  fit.squares = rough.squares;
  fit.converged = rough.converged;
  observe_at(records, rough.point, fit);
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd left = record_fit::residuals_along(records[r], fit.model.motions[r].path);
    std::vector<double>& used = fit.residuals.emplace_back();
    for (std::size_t k = 0; k < sample_count(records[r]); ++k) {
      if (!is_excluded(records[r], k)) used.push_back(left[static_cast<Eigen::Index>(k)]);
    }
  }
  constexpr int rounds = 3;
  constexpr int steps = 15;
  for (int round = 0; round < rounds; ++round) {
    const FitResult finer =
        fit_from(records, fit.observations, fit.model.point, with_steps(fit.setting, steps));
    if (!std::isfinite(finer.squares)) break;
    observe_at(records, finer.point, fit);
  }
  fit.setting.prior = fit.model.point.axis;
  return fit;
}

}  // namespace

LawFit fit_law(Records records, const LawModel& model, double least_squares) {
  const Observations readings = record_fit::all_readings(records);
  std::vector<FitResult> minima =
      first_minima(records, model, readings, without_time_offset(setting_of(model)));
  return refined(records, model,
                 fit_all_readings(records, model, readings, std::move(minima), least_squares));
}

LawFit search_again(Records records, const LawModel& model, double least_squares, LawFit found) {
  const Observations readings = record_fit::all_readings(records);
  const FitSetting setting = without_time_offset(setting_of(model));
  std::vector<FitResult> minima;
  for (const std::vector<LawPoint>& centres : {std::vector{found.model.point.axis}, model.starts}) {
    for (const FitResult& fit :
         promising_fits(records, readings, scattered(model, centres), setting, wide_search))
      minima.push_back(fit);
  }
  std::ranges::sort(minima, {}, &FitResult::squares);
  if (minima.empty() || minima.front().squares > hopeless * least_squares) return found;
  const FitResult best = fit_all_readings(records, model, readings, std::move(minima), least_squares);
  return best.squares < found.squares ? refined(records, model, best) : std::move(found);
}

LawErrors errors_of(Records records, const LawFit& fit) {
  constexpr std::size_t replicates = 300;
  const record_fit::ReadingReplicates found =
      record_fit::replicate_readings(records, fit.model, fit.setting, fit.noise, replicates);
  const auto own = record_fit::residual_statistics(record_fit::residuals_of(fit.model, fit.observations, {}));
  return {found.errors, record_fit::check_residuals(own, found.residuals)};
}

}  // namespace zerocount::law_identification

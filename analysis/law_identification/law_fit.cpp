#include "analysis/law_identification/law_fit.hpp"

#include <algorithm>
#include <cmath>

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

/// Squares in multiples of those of another law from which a law is not searched further, and the steps that
/// it still takes.
constexpr double hopeless = 100.0;
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

/// The fit to all readings. The time offset is left free in the last steps only: far from a minimum it would
/// make up for a wrong inertia.
FitResult fit_all_readings(Records records, const LawModel& model, const FitSetting& setting,
                           double least_squares) {
  FitSetting undelayed = setting;
  undelayed.free.back() = false;
  const Observations readings = record_fit::all_readings(records);
  std::vector<FitResult> minima = promising_fits(records, readings, model.starts, undelayed);
  if (minima.empty()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: no starting point of the friction model {} can be simulated along the records, "
                    "the rotor is too fast for their sampling; are the units right?",
                    records.front().name, friction::traits_of(model.law).word));
  }
  if (minima.front().squares > hopeless * least_squares) {
    return fit_from(records, readings, minima.front().point, with_steps(setting, hopeless_steps));
  }
  minima = fits_from(records, readings, minima, with_steps(undelayed, last_steps));
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

}  // namespace

LawFit fit_law(Records records, const LawModel& model, double least_squares) {
  LawFit fit;
  fit.setting.model = model.axis;
  fit.setting.free = model.free;
  const FitResult rough = fit_all_readings(records, model, fit.setting, least_squares);
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

LawErrors errors_of(Records records, const LawFit& fit) {
  constexpr std::size_t replicates = 300;
  const record_fit::ReadingReplicates found =
      record_fit::replicate_readings(records, fit.model, fit.setting, fit.noise, replicates);
  const auto own = record_fit::residual_statistics(record_fit::residuals_of(fit.model, fit.observations, {}));
  return {found.errors, record_fit::check_residuals(own, found.residuals)};
}

}  // namespace zerocount::law_identification

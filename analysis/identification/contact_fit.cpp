#include "analysis/identification/contact_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "analysis/identification/reading_replicates.hpp"
#include "analysis/identification/residual_checks.hpp"
#include "analysis/identification/starting_point.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::identification {
namespace {

/// Lower limit of the noise of readings that are not counts: smaller residuals are rounding errors.
constexpr double min_noise = 1e-6;

/// Variance of a reading in the first fit: that of a count.
constexpr double first_variance = 1.0 / 12.0;

constexpr int max_rounds = 6;

/// The rounds end when the fit changes by less than this many (textbook) standard deviations.
constexpr double small_change = 0.05;

Observations all_readings(std::span<const TestRecord> records) {
  Observations observations;
  for (const TestRecord& record : records) {
    std::vector<AngleObservation>& of_record = observations.emplace_back();
    for (std::size_t k = 0; k < record.reading.size(); ++k) {
      if (is_excluded(record, k)) continue;
      of_record.push_back({k, k, record.reading[k] + middle_of_reading(record), first_variance});
    }
  }
  return observations;
}

/// The coordinate of a parameter with a value in its own unit; λ at σ0 = 1 N m.
double coordinate_of(Coordinate coordinate, double value) {
  if (coordinate == creep_exponent || coordinate == time_offset) return value;
  return coordinate == log_limit ? -std::log(value) : std::log(value);
}

/// True if the records have slow branches and no ring-downs.
bool are_slow_alone(std::span<const TestRecord> records) {
  return has_slow_branches(records) &&
         std::none_of(records.begin(), records.end(),
                      [](const TestRecord& record) { return record.parts.ring_downs() > 0; });
}

FitSetting setting_for(std::span<const TestRecord> records, const std::vector<KnownParameter>& known) {
  FitSetting setting;
  setting.free.fill(true);
  setting.creep_torque = creep_torque_for(records, known);
  ContactPoint values = ContactPoint::Zero();
  for (const auto& [coordinate, value] : known) {
    setting.free[coordinate] = false;
    values[coordinate] = coordinate_of(coordinate, value);
  }
  // Slow parts hardly change from one sample to the next: a free offset would lead their fit astray.
  if (are_slow_alone(records)) setting.free[time_offset] = false;
  setting.prior = starting_point(records, setting.creep_torque, values, setting.free);
  return setting;
}

/// Measured − modelled angle, for counts that of the middle of the count; 0 where readings are masked.
Eigen::VectorXd residuals_along(const TestRecord& record, const Eigen::VectorXd& path) {
  Eigen::VectorXd left = readings_of(record).array() + middle_of_reading(record) - path.array();
  for (std::size_t k = 0; k < record.excluded.size(); ++k) {
    if (record.excluded[k]) left[static_cast<Eigen::Index>(k)] = 0.0;
  }
  return left;
}

void update_misfit(std::span<const TestRecord> records, ContactFit& fit) {
  fit.misfit.clear();
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd left = residuals_along(records[r], fit.model.motions[r].path);
    fit.misfit.push_back(std::sqrt(left.squaredNorm() / static_cast<double>(used_samples(records[r]))));
  }
}

void observe_again(std::span<const TestRecord> records, ContactFit& fit) {
  fit.noise.clear();
  fit.observations.resize(records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd& path = fit.model.motions[r].path;
    const Eigen::VectorXd readings = readings_of(records[r]);
    fit.noise.push_back(records[r].counted ? counting_noise(records[r], path, readings)
                                           : std::max(fit.misfit[r], min_noise));
    observe(records[r], path, readings, fit.noise[r], fit.observations[r]);
  }
}

/// True if quantisation and noise explain the residuals. For counts the test is the distance of the path from
/// the counts, for other readings the autocorrelation of the residuals.
bool is_explained(const TestRecord& record, const Eigen::VectorXd& path) {
  const Eigen::VectorXd readings = readings_of(record);
  const auto rms = [](const Eigen::ArrayXd& values) { return std::sqrt(values.square().mean()); };
  const Eigen::ArrayXd left = residuals_along(record, path);
  const Eigen::Index steps = left.size() - 1;
  const double change = rms(left.tail(steps) - left.head(steps)) / std::numbers::sqrt2;
  if (record.counted) {
    constexpr double tolerated = 0.05;  // of a count: the accuracy of the rough fit
    // Along a path with large errors, counting_noise() overestimates.
    const double noise = std::min(counting_noise(record, path, readings), change);
    return rms((left.abs() - 0.5).max(0.0)) < tolerated + noise;
  }
  constexpr double arithmetic = 1e-3;
  return rms(left) < 1.5 * change || rms(left) < arithmetic;
}

bool are_explained(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    Eigen::VectorXd path = angle_path(records[r], point.contact, setting.creep_torque);
    path.array() += point.offset[static_cast<Eigen::Index>(r)];
    if (!is_explained(records[r], path)) return false;
  }
  return true;
}

bool can_be_followed(const RecordMotion& motion) {
  return motion.path.allFinite() && motion.sensitivity.allFinite();
}

bool can_be_followed(const FittedModel& model) {
  return std::all_of(model.motions.begin(), model.motions.end(),
                     [](const RecordMotion& motion) { return can_be_followed(motion); });
}

/// The setting with only those coordinates free that the observations determine. The others keep their
/// values: far from a minimum, or where the law is not exact, they would run away to what a wrong spring
/// leaves. Residuals that are larger and longer correlated than the
/// errors of the observations count as errors.
FitSetting with_told_coordinates(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting) {
  // Standard deviations from which a coordinate counts as not determined.
  constexpr double untold_logarithm = 0.7;
  constexpr double untold_exponent = 1.0;
  constexpr double untold_offset = 0.5;
  const ResidualStatistics residuals = residual_statistics(residuals_of(model, observations, {}));
  const double error =
      std::max(1.0, std::sqrt(residuals.squares /
                              static_cast<double>(std::max<std::size_t>(residuals.observations, 1)) *
                              residuals.correlation_length));
  FitSetting told = setting;
  // One after the other: if only a combination of two is not determined, holding one of them is enough.
  for (double worst = 2.0; worst > 1.0;) {
    const Eigen::VectorXd variance = textbook_covariance(model, observations, told).diagonal();
    worst = 0.0;
    Coordinate least_told = time_offset;
    for (const Coordinate coordinate :
         {log_damping, log_inertia, log_alpha, log_limit, creep_exponent, time_offset}) {
      const double untold = coordinate == creep_exponent ? untold_exponent
                            : coordinate == time_offset  ? untold_offset
                                                         : untold_logarithm;
      const double ratio = told.free[coordinate] ? error * std::sqrt(variance[coordinate]) / untold : 0.0;
      if (ratio <= worst) continue;
      worst = ratio;
      least_told = coordinate;
    }
    if (worst > 1.0) told.free[least_told] = false;
  }
  return told;
}

/// A contact with the offsets for which the residuals have the mean 0.
FitPoint with_mean_offsets(std::span<const TestRecord> records, const ContactPoint& contact,
                           const FitSetting& setting) {
  FitPoint point{contact, Eigen::VectorXd(records.size())};
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd path = angle_path(records[r], contact, setting.creep_torque);
    const double mean =
        residuals_along(records[r], path).sum() / static_cast<double>(used_samples(records[r]));
    point.offset[static_cast<Eigen::Index>(r)] =
        std::isfinite(mean) ? mean : records[r].reading.front() + middle_of_reading(records[r]);
  }
  return point;
}

/// The fit from the starting point. If the slow parts are the whole test, that is already their best fit, and
/// only what the readings determine beside it is left free.
FitResult first_fit(std::span<const TestRecord> records, const Observations& observations,
                    const FitPoint& start, const FitSetting& setting) {
  if (!are_slow_alone(records)) return fit_jointly(records, observations, start, setting);
  const FittedModel model = model_at(records, start, setting);
  if (!can_be_followed(model)) return fit_jointly(records, observations, start, setting);
  return fit_jointly(records, observations, start, with_told_coordinates(model, observations, setting));
}

/// The fit from a point, to the end of its setting's steps; the point is the mean of the prior.
FitResult fit_from(std::span<const TestRecord> records, const Observations& observations,
                   const FitPoint& start, FitSetting setting) {
  setting.prior = start.contact;
  return fit_jointly(records, observations, start, setting);
}

/// Frees the time offset, if `setting` does, after the other coordinates. Far from a minimum the offset would
/// make up for a wrong inertia.
FitResult with_time_offset(std::span<const TestRecord> records, const Observations& observations,
                           const FitResult& from, FitSetting setting) {
  if (!setting.free[time_offset]) return from;
  setting.max_steps = 15;
  const FitResult found = fit_jointly(records, observations, from.point, setting);
  return found.squares < from.squares ? found : from;
}

/// A few steps from the best of the starting points `starts`; at most three of them, in the order of their
/// sums of squares.
std::vector<FitResult> promising_fits(std::span<const TestRecord> records, const Observations& observations,
                                      const std::vector<ContactPoint>& starts, FitSetting setting) {
  std::vector<FitResult> fits;
  for (const ContactPoint& start : starts) {
    ContactPoint contact = setting.prior;
    for (std::size_t j = 0; j < coordinate_count; ++j) {
      if (setting.free[j]) contact[j] = start[j];
    }
    fits.push_back({with_mean_offsets(records, contact, setting), 0.0});
  }
  constexpr std::size_t tried = 6;
  constexpr std::size_t continued = 3;
  constexpr double hopeless = 4.0;
  for (const auto& [most, steps] : {std::pair{fits.size(), 0}, std::pair{tried, 10}}) {
    fits.resize(std::min(fits.size(), most));
    setting.max_steps = steps;
    for (FitResult& fit : fits) fit = fit_from(records, observations, fit.point, setting);
    std::stable_sort(fits.begin(), fits.end(), [](const FitResult& one, const FitResult& other) {
      return one.squares < other.squares;
    });
  }
  fits.resize(std::min(fits.size(), continued));
  const double least = fits.front().squares;
  std::erase_if(fits, [&](const FitResult& fit) { return fit.squares > hopeless * least; });
  return fits;
}

/// The rough fit, to all readings with equal weights: from the starting point, or from others if that
/// explains too little.
FitPoint fit_roughly(std::span<const TestRecord> records, const FitSetting& setting) {
  const Observations observations = all_readings(records);
  FitSetting rough = setting;
  rough.tolerance = 1e-3;
  FitSetting undelayed = rough;
  undelayed.free[time_offset] = false;
  const FitPoint start = with_mean_offsets(records, setting.prior, setting);
  FitResult best =
      with_time_offset(records, observations, first_fit(records, observations, start, undelayed), rough);
  refuse_glitches(records, best.point, setting);
  if (are_explained(records, best.point, setting)) return best.point;
  FitSetting closer = undelayed;
  closer.tolerance = rough.tolerance = setting.tolerance;
  closer.max_steps = 30;
  std::vector alternatives{starts_with_other_softening};
  // Steps and long holds show the creep well enough; the holds of a closed loop may not.
  if (are_slow_alone(records)) alternatives.push_back(starts_with_other_creep);
  for (const auto& starting_points : alternatives) {
    const std::vector<ContactPoint> starts = starting_points(records, setting.prior, setting.creep_torque);
    for (const FitResult& other : promising_fits(records, observations, starts, undelayed)) {
      rough.prior = other.point.contact;
      const FitResult found = with_time_offset(records, observations,
                                               fit_from(records, observations, other.point, closer), rough);
      if (found.squares < best.squares) best = found;
      if (are_explained(records, best.point, setting)) return best.point;
    }
  }
  rough.max_steps = 50;
  return fit_from(records, observations, best.point, rough).point;
}

FittedModel followed_model(std::span<const TestRecord> records, const FitPoint& point,
                           const FitSetting& setting) {
  FittedModel model = model_at(records, point, setting);
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (can_be_followed(model.motions[r])) continue;
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the rotor that comes nearest to this record cannot be simulated: it is too "
                    "stiff, too light or too strongly damped beside the sampling interval. Are the "
                    "units right?",
                    records[r].name));
  }
  return model;
}

/// The largest component of the remaining Gauss–Newton step, in textbook standard deviations.
double remaining_step(const ContactFit& fit, const FitSetting& setting) {
  const Eigen::MatrixXd covariance = textbook_covariance(fit.model, fit.observations, setting);
  const Eigen::VectorXd step = covariance * normal_equations(fit.model, fit.observations, setting).gradient;
  return (step.array().abs() / covariance.diagonal().array().sqrt()).maxCoeff();
}

/// The coordinates that a fit leaves free: those of its setting, or of them what the readings tell.
enum class Freedom { all, told };

Freedom usual_freedom(std::span<const TestRecord> records) {
  return are_slow_alone(records) ? Freedom::told : Freedom::all;
}

/// Alternates observe() and fit, starting at `from`.
void refine(std::span<const TestRecord> records, const FitPoint& from, int rounds, Freedom freedom,
            ContactFit& fit) {
  fit.model = followed_model(records, from, fit.setting);
  update_misfit(records, fit);
  for (int round = 0; round < rounds; ++round) {
    observe_again(records, fit);
    const FitSetting told = freedom == Freedom::told
                                ? with_told_coordinates(fit.model, fit.observations, fit.setting)
                                : fit.setting;
    if (remaining_step(fit, told) < small_change) break;
    const FitPoint point = fit_jointly(records, fit.observations, fit.model.point, told).point;
    fit.model = followed_model(records, point, fit.setting);
    update_misfit(records, fit);
  }
}

double spread(const ContactFit& fit) {
  const ResidualStatistics statistics = residual_statistics(residuals_of(fit.model, fit.observations, {}));
  return std::sqrt(statistics.squares / static_cast<double>(statistics.observations));
}

/// Fits with all coordinates free from the point of `fit` plus each of `changes`, and continues the best of
/// them. False if none is better than `fit`, which then stays as it is.
bool improve_from(std::span<const TestRecord> records, std::span<const ContactPoint> changes,
                  ContactFit& fit) {
  const ContactFit first = fit;
  bool improved = false;
  for (const ContactPoint& change : changes) {
    ContactFit other = first;
    FitPoint point = first.model.point;
    for (std::size_t j = 0; j < coordinate_count; ++j) {
      if (change[j] != 0.0 && first.setting.free[j]) other.setting.prior[j] = point.contact[j] += change[j];
    }
    other.setting.max_steps = 10;
    try {
      refine(records, point, 3, Freedom::all, other);
    } catch (const Failure&) {
      continue;  // a rotor that cannot be simulated
    }
    observe_again(records, other);
    if (spread(other) >= spread(fit)) continue;
    fit = other;
    improved = true;
  }
  if (!improved) return false;
  fit.setting.max_steps = first.setting.max_steps;
  refine(records, fit.model.point, max_rounds, Freedom::all, fit);
  return true;
}

}  // namespace

double creep_torque_for(std::span<const TestRecord> records, const std::vector<KnownParameter>& known) {
  const bool limit_known = std::any_of(known.begin(), known.end(), [](const KnownParameter& parameter) {
    return parameter.coordinate == log_limit;
  });
  if (limit_known) return 1.0;
  double largest = 0.0;
  for (const TestRecord& record : records) largest = std::max(largest, largest_torque(record));
  return 0.7 * largest;
}

ContactFit fit_contact(std::span<const TestRecord> records, const std::vector<KnownParameter>& known,
                       const StageReport& report) {
  ContactFit fit;
  if (report) report("starting values");
  fit.setting = setting_for(records, known);
  if (report) report("rough fit");
  const FitPoint point = fit_roughly(records, fit.setting);
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    if (fit.setting.free[j]) fit.setting.prior[j] = point.contact[j];
  }
  fit.model = followed_model(records, point, fit.setting);
  update_misfit(records, fit);
  refuse_glitches(records, point, fit.setting);
  // The rough fit has the smallest residuals of all; later fits do not reduce them much further.
  constexpr double rough_tolerance = 1.5;
  refuse_unexplained(records, fit, rough_tolerance);
  if (report) report("fit");
  refine(records, point, max_rounds, usual_freedom(records), fit);
  refuse_glitches(records, fit.model.point, fit.setting);
  refuse_unexplained(records, fit, 1.0);
  return fit;
}

void keep_time_offset(std::span<const TestRecord> records, ContactFit& fit) {
  FitPoint point = fit.model.point;
  point.contact[time_offset] = fit.setting.prior[time_offset] = 0.0;
  fit.setting.free[time_offset] = false;
  refine(records, point, max_rounds, usual_freedom(records), fit);
}

bool free_untold_coordinates(std::span<const TestRecord> records, ContactFit& fit) {
  if (!are_slow_alone(records)) return false;
  std::vector<ContactPoint> changes;
  // The held inertia and damping may be those of another minimum.
  for (const double inertia : {0.0, -1.0, -2.0, 1.0, 2.0}) {
    for (const double damping : {0.0, 2.0, -2.0}) {
      ContactPoint& change = changes.emplace_back(ContactPoint::Zero());
      change[log_inertia] = inertia;
      change[log_damping] = damping;
    }
  }
  return improve_from(records, changes, fit);
}

bool improve_softening(std::span<const TestRecord> records, ContactFit& fit) {
  if (!fit.setting.free[log_beta] || !fit.setting.free[log_k2]) return false;
  if (are_slow_alone(records)) return false;  // fit_slow_parts() has searched
  std::vector<ContactPoint> changes;
  for (const double shift : {-2.0, -4.0, -6.0, -8.0, 2.0, 4.0}) {
    ContactPoint& change = changes.emplace_back(ContactPoint::Zero());
    change[log_beta] = change[log_k2] = shift;
  }
  return improve_from(records, changes, fit);
}

}  // namespace zerocount::identification

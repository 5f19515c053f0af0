#include "analysis/record/fit/presliding/contact_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/record/fit/observations.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::fit {
namespace {

/// Largest ratio of the rotor's rate to the sampling rate at which the fits of slow parts start. A faster
/// rotor shows as little of its own motion, and takes longer to simulate.
constexpr double max_slow_rate = 4.0;

/// Number of simulated samples at which a single fit ends. A fit that converges simulates each record about a
/// hundred times.
constexpr double min_fit_samples = 8e6;
constexpr double fit_paths = 400.0;

constexpr int max_rounds = 6;

/// The rounds of a fit to observations end when the fit changes by less than this many (textbook) standard
/// deviations.
constexpr double small_change = 0.05;

/// The coordinate that corresponds to a value of the parameter in its own unit. For λ the torque scale σ0 is
/// 1 N m.
double coordinate_value(Coordinate coordinate, double value) {
  if (coordinate == creep_exponent || coordinate == time_offset) return value;
  return coordinate == log_limit ? -std::log(value) : std::log(value);
}

/// The settings of a fit, and the points from which it may start.
struct FitStart {
  FitSetting setting;
  /// Starting points, the best one first. It is also the mean of the prior in the settings.
  std::vector<Point> points;
};

FitStart start_for(Records records, const std::vector<KnownParameter>& known, double creep_torque) {
  FitStart start;
  FitSetting& setting = start.setting;
  setting.model = contact_model(creep_torque);
  std::size_t samples = 0;
  for (const TestRecord& record : records) samples += sample_count(record);
  setting.max_simulated = std::max(min_fit_samples, fit_paths * static_cast<double>(samples));
  setting.free = setting.model.free;
  Point values = Point::Zero(coordinate_count);
  for (const auto& [coordinate, value] : known) {
    setting.free[coordinate] = false;
    values[coordinate] = coordinate_value(coordinate, value);
  }
  // Slow parts hardly change from one sample to the next: a free offset would lead their fit astray.
  if (are_slow_alone(records)) setting.free[time_offset] = false;
  start.points = starting_points(records, creep_torque, values, setting.free);
  setting.prior = start.points.front();
  return start;
}

bool are_explained(Records records, const FitPoint& point, const FitSetting& setting) {
  for (std::size_t r = 0; r < records.size(); ++r) {
    Eigen::VectorXd path = modelled_path(records[r], setting.model, point.axis);
    path.array() += point.offset[static_cast<Eigen::Index>(r)];
    if (!is_explained(records[r], path)) return false;
  }
  return true;
}

bool can_be_followed(const FittedModel& model) {
  return std::all_of(model.motions.begin(), model.motions.end(), is_finite);
}

/// The settings of a fit in which only the coordinates that the observations determine are free. The others
/// keep their values; far from a minimum, or if the law is not exact, they would diverge to fit the residuals
/// of a wrong spring. Residuals that are larger and longer correlated than the errors of the observations
/// count as errors.
FitSetting with_told_coordinates(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting) {
  // Standard deviations from which a coordinate counts as not determined.
  constexpr double untold_logarithm = 0.7;
  constexpr double untold_exponent = 1.0;
  constexpr double untold_offset = 0.5;
  const ResidualStatistics residuals = residual_statistics(model, observations);
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

/// The first fit, from the starting point. If the records consist of slow parts only, the starting point is
/// already their best fit, and only the remaining coordinates that the readings determine are free.
FitResult first_fit(Records records, const Observations& observations, const FitPoint& start,
                    const FitSetting& setting) {
  if (!are_slow_alone(records)) return fit_jointly(records, observations, start, setting);
  const FittedModel model = model_at(records, start, setting);
  if (!can_be_followed(model)) return fit_jointly(records, observations, start, setting);
  return fit_jointly(records, observations, start, with_told_coordinates(model, observations, setting));
}

/// Continues a fit with the time offset free, if `setting` allows it, after the other coordinates have been
/// fitted. Far from a minimum the offset would compensate for a wrong inertia.
FitResult with_time_offset(Records records, const Observations& observations, const FitResult& from,
                           FitSetting setting) {
  if (!setting.free[time_offset]) return from;
  setting.max_steps = 15;
  const FitResult found = fit_jointly(records, observations, from.point, setting);
  return found.squares < from.squares ? found : from;
}

/// Points with another inertia and damping that explain the observations better than the model, with the
/// other coordinates adapted. Slow parts of records contain little information on the inertia, and a fit
/// adapts the other coordinates to a wrong one.
std::vector<FitResult> with_other_inertia(Records records, const Observations& observations,
                                          const FittedModel& model, const FitSetting& setting) {
  if (!setting.free[log_inertia] || !setting.free[log_damping]) return {};
  FitSetting others = setting;
  others.free[log_inertia] = others.free[log_damping] = false;
  std::vector<Point> changes = inertia_changes({0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0},
                                               {0.1, 0.3, 1.0, 3.0, 10.0, 30.0});
  std::erase_if(changes, [&](const Point& change) {
    return !is_sampled(records, setting.model, model.point.axis + change, max_slow_rate);
  });
  return better_points(records, observations, model, others, changes);
}

/// The starting points, in which each coordinate that is not free has the value of the prior's mean.
std::vector<Point> with_fixed(const std::vector<Point>& starts, const FitSetting& setting) {
  std::vector<Point> points(starts.size(), setting.prior);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    for (std::size_t j = 0; j < coordinate_count; ++j) {
      if (setting.free[j]) points[i][static_cast<Eigen::Index>(j)] = starts[i][static_cast<Eigen::Index>(j)];
    }
  }
  return points;
}

/// Simulated samples (FitModel::simulated) after which a fit of the usual effort 1 tries no more starting
/// points: some 20 s on two cores.
constexpr double usual_effort = 1.5e7;

bool has_spent_effort(const FitSetting& setting, double effort) {
  return static_cast<double>(setting.model.simulated->load()) > effort * usual_effort;
}

/// Copies of the records in which the torque acts later by this number of samples.
std::vector<TestRecord> with_later_torque(Records records, int samples) {
  std::vector<TestRecord> shifted(records.begin(), records.end());
  for (TestRecord& record : shifted) {
    const std::vector<motion::TorqueCourse> torque = record.torque;
    const auto last = static_cast<std::ptrdiff_t>(torque.size()) - 1;
    for (std::ptrdiff_t k = 0; k <= last; ++k) {
      const std::ptrdiff_t from = k - samples;
      record.torque[static_cast<std::size_t>(k)] =
          from < 0 ? motion::constant_torque(0.0) : torque[static_cast<std::size_t>(std::min(from, last))];
    }
    record.parts = parts_of(record);
  }
  return shifted;
}

/// The rough fit of the contact to all readings with equal weights. It starts from the first starting point,
/// and from other points if that fit explains too little.
FitPoint fit_roughly(Records records, const FitStart& start, double creep_torque, double effort) {
  const FitSetting& setting = start.setting;
  const Observations observations = all_readings(records);
  FitSetting rough = setting;
  rough.tolerance = 1e-3;
  FitSetting undelayed = rough;
  undelayed.free[time_offset] = false;
  std::optional<FitResult> first;  // the best one from the points tried so far
  const auto fit_at = [&](const Point& point) {
    undelayed.prior = rough.prior = point;
    const FitPoint at = with_mean_offsets(records, setting.model, point).point;
    const FitResult found =
        with_time_offset(records, observations, first_fit(records, observations, at, undelayed), rough);
    if (!first || found.squares < first->squares) first = found;
    refuse_glitches(records, first->point, setting);
  };
  const auto is_explained = [&] { return are_explained(records, first->point, setting); };
  fit_at(start.points.front());
  if (is_explained()) return first->point;
  // A delay that was not given: the fit has made up for it by a wrong spring and inertia, too.
  const double offset = first->point.axis[time_offset];
  constexpr double min_offset = 0.5;  // samples
  for (const int samples : {1, 2}) {
    if (!setting.free[time_offset] || std::abs(offset) < min_offset || has_spent_effort(setting, effort))
      break;
    const int shift = offset > 0.0 ? samples : -samples;
    const std::vector<TestRecord> shifted = with_later_torque(records, shift);
    Point point = starting_points(shifted, creep_torque, start.points.front(), setting.free).front();
    point[time_offset] = shift;
    fit_at(point);
    if (is_explained()) return first->point;
  }
  for (std::size_t i = 1; i < start.points.size(); ++i) {
    fit_at(start.points[i]);
    if (is_explained()) return first->point;
  }
  FitResult best = *first;
  // The other starting points vary the one of closed forms, which has no wrong minimum of its own.
  const Point& estimated = start.points.back();
  undelayed.prior = rough.prior = estimated;
  FitSetting closer = undelayed;
  closer.tolerance = rough.tolerance = setting.tolerance;
  closer.max_steps = 30;
  if (are_slow_alone(records)) {
    const FittedModel model = model_at(records, best.point, undelayed);
    if (can_be_followed(model)) {
      const std::vector<FitResult> others = with_other_inertia(records, observations, model, undelayed);
      if (!others.empty()) {
        const FitResult found = fit_from(records, observations, others.front().point, undelayed);
        if (found.squares < best.squares) best = found;
      }
    }
    refuse_glitches(records, best.point, setting);
    if (are_explained(records, best.point, setting)) return best.point;
  }
  std::vector alternatives{starts_with_other_softening};
  // Steps and long holds show the creep well enough; the holds of a closed loop may not.
  if (are_slow_alone(records)) alternatives.push_back(starts_with_other_creep);
  for (const auto& alternative : alternatives) {
    if (has_spent_effort(setting, effort)) return best.point;
    const std::vector<Point> starts = alternative(records, estimated, creep_torque);
    for (const FitResult& other :
         promising_fits(records, observations, with_fixed(starts, setting), undelayed)) {
      if (has_spent_effort(setting, effort)) break;
      rough.prior = other.point.axis;
      const FitResult found = with_time_offset(records, observations,
                                               fit_from(records, observations, other.point, closer), rough);
      if (found.squares < best.squares) best = found;
      if (are_explained(records, best.point, setting)) return best.point;
    }
  }
  if (has_spent_effort(setting, effort)) return best.point;
  rough.max_steps = 50;
  return fit_from(records, observations, best.point, rough).point;
}

FittedModel followed_model(Records records, const FitPoint& point, const FitSetting& setting) {
  FittedModel model = model_at(records, point, setting);
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (is_finite(model.motions[r])) continue;
    refuse(
        records[r].axis, records[r].name,
        "the axis that comes nearest to this record cannot be simulated: it is too stiff, too light or too "
        "strongly damped beside the sampling interval. Are the units right?");
  }
  return model;
}

/// The largest component of the remaining Gauss–Newton step, in textbook standard deviations; small if the
/// fit has converged.
double remaining_step(const ContactFit& fit, const FitSetting& setting) {
  const Eigen::MatrixXd covariance = textbook_covariance(fit.model, fit.observations, setting);
  const Eigen::VectorXd step = covariance * normal_equations(fit.model, fit.observations, setting).gradient;
  return (step.array().abs() / covariance.diagonal().array().sqrt()).maxCoeff();
}

/// Selection of the coordinates that are free in a fit: all free coordinates of its settings, or only those
/// of them that the readings determine.
enum class Freedom { all, told };

Freedom usual_freedom(Records records) {
  return are_slow_alone(records) ? Freedom::told : Freedom::all;
}

/// Refines a fit: starting at `from`, alternates observe(), which converts readings to observations along the
/// modelled path, and a fit to these observations.
/// @param rounds largest number of rounds
void refine(Records records, const FitPoint& from, int rounds, Freedom freedom, ContactFit& fit) {
  fit.model = followed_model(records, from, fit.setting);
  for (int round = 0; round < rounds; ++round) {
    observe_again(records, fit);
    const FitSetting told = freedom == Freedom::told
                                ? with_told_coordinates(fit.model, fit.observations, fit.setting)
                                : fit.setting;
    if (remaining_step(fit, told) < small_change) break;
    const FitPoint point = fit_jointly(records, fit.observations, fit.model.point, told).point;
    fit.model = followed_model(records, point, fit.setting);
  }
}

double spread(const ContactFit& fit) {
  const ResidualStatistics statistics = residual_statistics(fit.model, fit.observations);
  return std::sqrt(statistics.squares / static_cast<double>(statistics.observations));
}

/// Repeats the fit from another inertia and damping, if these explain the observations better.
void improve_inertia(Records records, ContactFit& fit) {
  const std::vector<FitResult> others = with_other_inertia(records, fit.observations, fit.model, fit.setting);
  if (others.empty()) return;
  ContactFit other = fit;
  other.setting.prior = others.front().point.axis;
  try {
    refine(records, others.front().point, max_rounds, usual_freedom(records), other);
  } catch (const Failure&) {
    return;  // a rotor that cannot be simulated
  }
  observe_again(records, other);
  if (spread(other) < spread(fit)) fit = other;
}

/// Tries to improve a fit: takes a few steps with all coordinates free from the point of `fit` plus each of
/// `changes`, and fits the best result to the end.
/// @returns false if that is not better than `fit`, which then stays unchanged.
bool improve_from(Records records, std::span<const Point> changes, ContactFit& fit) {
  if (has_spent_effort(fit.setting, fit.effort)) return false;
  std::vector<Point> starts;
  for (const Point& change : changes) {
    Point& start = starts.emplace_back(fit.model.point.axis);
    for (std::size_t j = 0; j < coordinate_count; ++j) {
      if (fit.setting.free[j]) start[static_cast<Eigen::Index>(j)] += change[static_cast<Eigen::Index>(j)];
    }
  }
  const std::vector<FitResult> found =
      promising_fits(records, fit.observations, starts, fit.setting, {{3, 8}});
  if (found.empty()) return false;
  ContactFit other = fit;
  other.setting.prior = found.front().point.axis;
  try {
    refine(records, found.front().point, max_rounds, Freedom::all, other);
  } catch (const Failure&) {
    return false;  // a rotor that cannot be simulated
  }
  observe_again(records, other);
  if (spread(other) >= spread(fit)) return false;
  fit = other;
  return true;
}

}  // namespace

double misfit_of(Records records, const Fit& fit, std::size_t record) {
  return misfit_along(records[record], fit.model.motions[record].path);
}

double creep_torque_for(Records records, const std::vector<KnownParameter>& known) {
  const bool limit_known = std::any_of(known.begin(), known.end(), [](const KnownParameter& parameter) {
    return parameter.coordinate == log_limit;
  });
  if (limit_known) return 1.0;
  double largest = 0.0;
  for (const TestRecord& record : records) largest = std::max(largest, largest_torque(record));
  return 0.7 * largest;
}

ContactFit fit_contact(Records records, const std::vector<KnownParameter>& known, const StageReport& report,
                       double effort) {
  ContactFit fit;
  fit.effort = effort;
  if (report) report("starting values");
  fit.creep_torque = creep_torque_for(records, known);
  const FitStart start = start_for(records, known, fit.creep_torque);
  fit.setting = start.setting;
  if (report) report("rough fit");
  const FitPoint point = fit_roughly(records, start, fit.creep_torque, effort);
  for (std::size_t j = 0; j < coordinate_count; ++j) {
    if (fit.setting.free[j]) fit.setting.prior[j] = point.axis[j];
  }
  fit.model = followed_model(records, point, fit.setting);
  refuse_glitches(records, point, fit.setting);
  // The rough fit has the smallest residuals of all; later fits do not reduce them much further.
  constexpr double rough_tolerance = 1.5;
  refuse_unexplained(records, fit, rough_tolerance);
  if (report) report("fit");
  refine(records, point, max_rounds, usual_freedom(records), fit);
  if (are_slow_alone(records)) improve_inertia(records, fit);
  refuse_glitches(records, fit.model.point, fit.setting);
  refuse_unexplained(records, fit, 1.0);
  return fit;
}

void keep_time_offset(Records records, ContactFit& fit) {
  FitPoint point = fit.model.point;
  point.axis[time_offset] = fit.setting.prior[time_offset] = 0.0;
  fit.setting.free[time_offset] = false;
  refine(records, point, max_rounds, usual_freedom(records), fit);
}

bool has_ended_early(const ContactFit& fit) {
  return has_spent_effort(fit.setting, fit.effort);
}

bool improve_softening(Records records, ContactFit& fit) {
  if (!fit.setting.free[log_beta] || !fit.setting.free[log_k2]) return false;
  if (are_slow_alone(records)) return false;  // fit_slow_parts() has searched
  std::vector<Point> changes;
  for (const double shift : {-2.0, -4.0, -6.0, -8.0, 2.0, 4.0})
    changes.push_back(change_of({{log_beta, shift}, {log_k2, shift}}));
  return improve_from(records, changes, fit);
}

}  // namespace zerocount::fit

#include "analysis/record/fit/model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/record.hpp"
#include "core/friction/law.hpp"
#include "core/plant/plant.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {

Quantity coordinate_quantity(const std::string& name, std::string_view key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate) {
  Quantity quantity{name, std::string(key), unit, point[coordinate], Eigen::VectorXd::Zero(point.size()),
                    true};
  quantity.slope[coordinate] = 1.0;
  return quantity;
}

Quantity time_offset_quantity(const Point& point) {
  Quantity quantity = coordinate_quantity("time_offset", "", "samples", point, point.size() - 1);
  quantity.logarithmic = false;
  return quantity;
}

QuantityEstimate interval_of_errors(const Quantity& quantity, const Eigen::MatrixXd& errors,
                                    double widening) {
  const Eigen::VectorXd own = errors.leftCols(quantity.slope.size()) * quantity.slope;
  const double mean = own.mean();
  const Eigen::VectorXd wide = (mean + widening * (own.array() - mean)).matrix();
  std::vector<double> sorted(wide.data(), wide.data() + wide.size());
  std::sort(sorted.begin(), sorted.end());
  QuantityEstimate estimate;
  estimate.value = quantity.value - mean;
  estimate.standard_error =
      std::sqrt((wide.array() - mean).square().sum() / static_cast<double>(wide.size() - 1));
  estimate.low = quantity.value - statistics::interpolated_quantile(sorted, 0.975);
  estimate.high = quantity.value - statistics::interpolated_quantile(sorted, 0.025);
  return estimate;
}

QuantityEstimate on_parameter_scale(const Quantity& quantity, QuantityEstimate estimate) {
  if (quantity.logarithmic) {
    const double value = std::exp(estimate.value);
    return {value, value * estimate.standard_error, std::exp(estimate.low), std::exp(estimate.high)};
  }
  if (quantity.key != parameter::friction::n) return estimate;
  constexpr double min_exponent = 1.0;
  for (double* number : {&estimate.value, &estimate.low, &estimate.high}) {
    *number = std::max(*number, min_exponent);
  }
  return estimate;
}

namespace {

/// Truncation error allowed per step of the simulated motion, and amplitude below which an oscillation counts
/// as decayed, in units of the readings.
constexpr double motion_tolerance = 1e-9;
constexpr double rest_tolerance = 1e-8;

/// Step of the finite differences with respect to coordinates of a fit: small enough for a smooth path, far
/// above the error of the integration.
constexpr double difference_step = 1e-6;

/// The friction contact, linearised just after a reversal, where it is stiffest.
friction::LinearContact stiffest_contact(const AxisParameters& axis) {
  return friction::stiffest_of(friction::traits_of(axis.friction.model)
                                   .linear_contacts(axis.plant, axis.friction, axis.friction.uniform));
}

/// Decay rate of the slowest oscillation about a point of the contact's spring, 1/s.
double decay_rate(const AxisParameters& axis) {
  const double damping = axis.plant.presliding_damping;
  const double inertia = axis.plant.inertia;
  const double stiffness = axis.friction.uniform.k1;
  const double discriminant = damping * damping - 4.0 * inertia * stiffness;
  if (discriminant <= 0.0) return damping / (2.0 * inertia);
  return 2.0 * stiffness / (damping + std::sqrt(discriminant));
}

/// The long integration steps for the time in which creep alone moves the axis.
LongSteps long_steps(const AxisParameters& axis) {
  if (!friction::has_creep(axis.friction.model)) return {};
  constexpr double settled = 40.0;     // exp(−40) of an oscillation is below rounding
  constexpr double creep_step = 0.03;  // of the time constant of creep
  return {settled / decay_rate(axis), creep_step / axis.friction.uniform.alpha};
}

/// Adds the twist of a compliance in series to the path: compliance (in units of the readings/(N m)) times
/// the torque that acted until each reading.
/// @param offset time offset of the torque, samples
void add_twist(const TestRecord& record, double compliance, double offset, Eigen::VectorXd& path) {
  const double delay = record.delay_fraction + offset;
  const auto last = static_cast<double>(record.torque.size() - 1);
  for (Eigen::Index k = 0; k < path.size(); ++k) {
    const double interval = std::ceil(static_cast<double>(k) - delay) - 1.0;
    if (interval < 0.0) continue;  // the torque is 0 before the first sample
    const motion::TorqueCourse& torque = record.torque[static_cast<std::size_t>(std::min(interval, last))];
    path[k] += compliance * motion::course_after(torque, record.sample_time).now;
  }
}

/// Number of samples of a record, each weighted by the integration steps that a fast rotor needs in it.
std::int64_t weighted_samples(const TestRecord& record, const AxisParameters& axis) {
  const double steps = 1.0 + fastest_rate(axis) * record.sample_time;
  return static_cast<std::int64_t>(std::min(steps, 1e3) * static_cast<double>(sample_count(record)));
}

SampledPath path_at(const TestRecord& record, const FitModel& model, const Point& point) {
  const AxisParameters axis = model.parameters_at(point);
  plant::Plant plant(axis.plant, axis.friction, record.start,
                     {motion_tolerance * record.unit, rest_tolerance * record.unit});
  model.simulated->fetch_add(weighted_samples(record, axis));
  const double offset = point[point.size() - 1];
  SampledPath path = sampled_path(record, std::move(plant), offset, long_steps(axis));
  if (model.series_compliance) {
    add_twist(record, model.series_compliance(point) / record.unit, offset, path.angle);
  }
  return path;
}

}  // namespace

double fastest_rate(const AxisParameters& parameters) {
  const friction::LinearContact contact = stiffest_contact(parameters);
  return std::max(std::sqrt(contact.stiffness / parameters.plant.inertia),
                  contact.damping / parameters.plant.inertia);
}

Eigen::VectorXd modelled_path(const TestRecord& record, const FitModel& model, const Point& point) {
  return path_at(record, model, point).angle;
}

std::int64_t samples_of_paths(Records records, const FitModel& model, const Point& point) {
  const AxisParameters axis = model.parameters_at(point);
  std::int64_t samples = 0;
  for (const TestRecord& record : records) samples += weighted_samples(record, axis);
  return samples;
}

std::vector<RecordMotion> modelled_motions(Records records, const FitModel& model, const Point& point,
                                           const FreeCoordinates& free, std::vector<RecordMotion> known) {
  const Eigen::Index offset = dimension_of(model) - 1;
  std::vector<Eigen::Index> columns;
  if (known.empty()) columns.push_back(offset);  // that of the time offset comes with the path itself
  for (Eigen::Index j = 0; j < offset; ++j) {
    if (free[static_cast<std::size_t>(j)]) columns.push_back(j);
  }
  std::vector<RecordMotion> motions = std::move(known);
  motions.resize(records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    if (motions[r].sensitivity.size() > 0) continue;
    motions[r].sensitivity.setZero(static_cast<Eigen::Index>(sample_count(records[r])), dimension_of(model));
  }
  parallel::for_each_index(
      records.size() * columns.size(),
      [&](std::size_t i) {
        const std::size_t r = i % records.size();
        const Eigen::Index j = columns[i / records.size()];
        if (j == offset) {
          SampledPath path = path_at(records[r], model, point);
          if (free.back()) motions[r].sensitivity.col(j) = -path.velocity;
          motions[r].path = std::move(path.angle);
          return;
        }
        Point moved = point;
        moved[j] += difference_step;
        motions[r].sensitivity.col(j) = modelled_path(records[r], model, moved);
      },
      "motions");
  for (RecordMotion& motion : motions) {
    for (const Eigen::Index j : columns) {
      if (j == offset) continue;
      const double step = (point[j] + difference_step) - point[j];
      motion.sensitivity.col(j) = (motion.sensitivity.col(j) - motion.path) / step;
    }
  }
  return motions;
}

bool is_sampled(Records records, const FitModel& model, const Point& point, double max_rate) {
  const double rate = fastest_rate(model.parameters_at(point));
  return std::all_of(records.begin(), records.end(),
                     [&](const TestRecord& record) { return rate * record.sample_time <= max_rate; });
}

bool is_within_reach(Records records, const FitModel& model, const Point& prior, const Point& point) {
  for (std::size_t j = 0; j < model.ranges.size(); ++j) {
    const CoordinateRange& range = model.ranges[j];
    const double value = point[static_cast<Eigen::Index>(j)];
    const double increase = value - prior[static_cast<Eigen::Index>(j)];
    if (!(increase <= range.max_increase && increase >= -range.max_decrease)) return false;
    if (!(value <= range.high && value >= range.low)) return false;
  }
  if (is_sampled(records, model, point)) return true;
  return fastest_rate(model.parameters_at(point)) <= 2.0 * fastest_rate(model.parameters_at(prior));
}

}  // namespace zerocount::fit

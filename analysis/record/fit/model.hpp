#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "analysis/record/fit/record.hpp"
#include "core/friction/friction_model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::fit {

/// Point of a fit: the coordinates (unknowns) of a model. They are mostly logarithms of its parameters. The
/// last one is the time offset, the samples by which the torque acts later than recorded; it is common to all
/// records.
using Point = Eigen::VectorXd;

/// A reported quantity, such as a friction parameter: a linear or nearly linear function of the coordinates
/// of a fit.
struct Quantity {
  std::string name;
  /// Manifest key of the parameter; empty if a manifest has no such parameter.
  std::string key;
  std::string unit;  ///< Unit of the parameter on a rotary axis.
  /// Value of the quantity at the fit: its logarithm if `logarithmic`, otherwise the quantity itself.
  double value{0.0};
  Eigen::VectorXd slope;   ///< [coordinate] Derivatives of `value` with respect to the coordinates.
  bool logarithmic{true};  ///< Whether `value` is the logarithm of the quantity.
};

/// The reported quantity whose logarithm is the given coordinate of the point.
Quantity coordinate_quantity(const std::string& name, std::string_view key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate);

/// The time offset, the last coordinate of the point, as a reported quantity.
Quantity time_offset_quantity(const Point& point);

/// Value and 95 % interval of a quantity, on the scale of Quantity::value: a logarithm if
/// Quantity::logarithmic.
struct QuantityEstimate {
  double value{0.0};
  double standard_error{0.0};
  double low{0.0};
  double high{0.0};

  double half_width() const { return 0.5 * (high - low); }
};

/// The 95 % interval of a quantity, from the errors of replicates of the fit. The errors are first multiplied
/// by `widening` about their mean.
/// @param errors [replicate, coordinate]; further columns are ignored
QuantityEstimate interval_of_errors(const Quantity& quantity, const Eigen::MatrixXd& errors, double widening);

/// Largest half-width of a 95 % interval with which a quantity counts as determined by the records. For a
/// logarithm it is 0.7, a factor of two to each side. For n and for the time offset (samples) it is 1.
inline double max_half_width(bool logarithmic) {
  return logarithmic ? 0.7 : 1.0;
}

/// Converts an estimate to the scale of the parameter itself: the exponential of a logarithm; the creep
/// exponent n is at least 1.
QuantityEstimate on_parameter_scale(const Quantity& quantity, QuantityEstimate estimate);

using Records = std::span<const TestRecord>;

/// [coordinate] Whether a fit changes the coordinate; the others keep their values.
using FreeCoordinates = std::vector<bool>;

/// Largest |time offset| (samples) that a fit may find.
inline constexpr double max_time_offset = 2.0;

/// Parameters of an axis (the plant) and of its friction.
struct AxisParameters {
  motion::PlantParameters plant;
  friction::FrictionAlongRotor friction;
};

/// Range of the values of a coordinate that a fit may try, relative to the mean of the fit's prior.
struct CoordinateRange {
  /// Largest decrease of the coordinate below the mean of the prior.
  double max_decrease{std::numeric_limits<double>::infinity()};
  /// Largest increase of the coordinate above the mean of the prior.
  double max_increase{std::numeric_limits<double>::infinity()};
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
};

/// A friction law as a function of the fitted coordinates, with the quantities that a fit reports. The motion
/// is simulated by core's Plant.
struct FitModel {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  /// [coordinate] Range in which a fit may change the coordinate; the last one is the range of the time
  /// offset.
  std::vector<CoordinateRange> ranges;
  /// [coordinate] Whether a fit may change the coordinate; false for a coordinate that the law does not have.
  FreeCoordinates free;
  std::function<AxisParameters(const Point&)> parameters_at;
  /// Function that returns the compliance of a fixture in series with the friction contact, rad/(N m); empty
  /// if there is no fixture.
  std::function<double(const Point&)> series_compliance{};
  std::function<std::vector<Quantity>(const Point&)> quantities_at;
  std::vector<Point> starts{};  ///< Points from which fits start.
  /// Function that returns the lines below `friction:` in a manifest for the parameters that are not fitted,
  /// with the units of a rotary axis; empty if there are none.
  std::function<std::string(const Point&)> fixed_lines{};
  /// The line `sliding_damping` below `plant:` in a manifest, for a law whose records do not determine this
  /// damping; empty: no such line.
  std::string plant_lines{};
  /// Number of samples simulated with this model and its copies. A sample is weighted by the integration
  /// steps that a fast rotor needs in it. The number does not depend on the number of threads.
  std::shared_ptr<std::atomic<std::int64_t>> simulated{std::make_shared<std::atomic<std::int64_t>>(0)};
};

inline Eigen::Index dimension_of(const FitModel& model) {
  return static_cast<Eigen::Index>(model.ranges.size());
}

/// The range in which a fit may change the time offset.
inline CoordinateRange time_offset_range() {
  return {.low = -max_time_offset, .high = max_time_offset};
}

/// Fastest rate of the axis before it slides, 1/s: of its oscillation or of its damping. It limits the steps
/// of a simulation.
double fastest_rate(const AxisParameters& parameters);

/// Modelled motion of one record, with its derivatives.
struct RecordMotion {
  Eigen::VectorXd path;  ///< [sample] Modelled angle since the first sample, in the record's unit.
  /// [sample, coordinate] Derivatives of `path` with respect to the coordinates; 0 for coordinates that are
  /// not free.
  Eigen::MatrixXd sensitivity;
};

/// Modelled path of a record at the point, simulated to 0.01 of the record's unit. In a long hold of an
/// evenly sampled record, once only creep moves the rotor, the steps are longer and the samples are
/// interpolated by cubics.
Eigen::VectorXd modelled_path(const TestRecord& record, const FitModel& model, const Point& point);

/// Modelled motions of all records with their derivatives. The derivative with respect to the time offset
/// comes from the velocity, the others are forward differences. The records are simulated in parallel.
/// @param free coordinates whose derivatives are computed
/// @param known empty, or the motions at this point with their paths and only the derivatives with respect to
/// the time offset
std::vector<RecordMotion> modelled_motions(Records records, const FitModel& model, const Point& point,
                                           const FreeCoordinates& free, std::vector<RecordMotion> known = {});

/// Number of samples by which a simulation of all records at a point would increase FitModel::simulated.
std::int64_t samples_of_paths(Records records, const FitModel& model, const Point& point);

/// True if a fit whose prior has the mean `prior` may try `point`. All coordinates must be within their
/// ranges. The motion must be at most 20 times as fast as the sampling, or at most twice as fast as the
/// motion at `prior`.
bool is_within_reach(Records records, const FitModel& model, const Point& prior, const Point& point);

/// True if the motion at the point is at most `max_rate` times as fast as the sampling of every record. A
/// faster motion takes long to simulate, and the records do not determine it.
bool is_sampled(Records records, const FitModel& model, const Point& point, double max_rate = 20.0);

}  // namespace zerocount::fit

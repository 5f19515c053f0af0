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

#include "analysis/fit/record.hpp"
#include "core/friction/friction_model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::fit {

/// Coordinates of a model: mostly logarithms of its parameters, and last the time offset, the samples by
/// which the torque acts later than recorded; common to all records.
using Point = Eigen::VectorXd;

/// A reported quantity: a linear or nearly linear function of the coordinates.
struct Quantity {
  std::string name;
  /// Manifest key of the parameter. Empty if a manifest has no such parameter.
  std::string key;
  std::string unit;  ///< Unit of the parameter on a rotary axis.
  /// Value at the fit: the logarithm of the quantity if `logarithmic`, otherwise the quantity itself.
  double value{0.0};
  Eigen::VectorXd slope;   ///< derivatives of `value` with respect to the coordinates
  bool logarithmic{true};  ///< whether `value` is a logarithm
};

/// A quantity whose logarithm is one of the coordinates.
Quantity coordinate_quantity(const std::string& name, std::string_view key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate);

/// The time offset, the last coordinate.
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

/// The estimate on the scale of the parameter: the exponential of a logarithm; n at least 1.
QuantityEstimate on_parameter_scale(const Quantity& quantity, QuantityEstimate estimate);

using Records = std::span<const TestRecord>;

/// Coordinates that a fit changes; the others keep their values.
using FreeCoordinates = std::vector<bool>;

/// Largest |time offset| (samples) that a fit may find.
inline constexpr double max_time_offset = 2.0;

/// An axis with its friction.
struct AxisParameters {
  motion::PlantParameters plant;
  friction::FrictionAlongRotor friction;
};

/// The values of a coordinate that a fit may try.
struct CoordinateRange {
  /// Largest decrease below the mean of the prior.
  double max_decrease{std::numeric_limits<double>::infinity()};
  /// Largest increase above the mean of the prior.
  double max_increase{std::numeric_limits<double>::infinity()};
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
};

/// A friction law as a function of the fitted coordinates, and the quantities that are reported of a fit. The
/// motion is simulated by core's Plant.
struct FitModel {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  /// [coordinate] range of each coordinate; the last one is the range of the time offset.
  std::vector<CoordinateRange> ranges;
  FreeCoordinates free;  ///< [coordinate] False for a coordinate that the law does not have.
  std::function<AxisParameters(const Point&)> parameters_at;
  /// Compliance of a fixture in series with the contact, rad/(N m); empty: none.
  std::function<double(const Point&)> series_compliance{};
  std::function<std::vector<Quantity>(const Point&)> quantities_at;
  std::vector<Point> starts{};  ///< starting points of the fit
  /// Lines below `friction:` in a manifest for the parameters that are not fitted, with the units of a rotary
  /// axis. They may be empty.
  std::function<std::string(const Point&)> fixed_lines{};
  /// The line `sliding_damping` below `plant:` where the records do not determine it; empty: no such line.
  std::string plant_lines{};
  /// Number of samples simulated with this model and its copies. A sample is weighted by the integration
  /// steps that a fast rotor needs in it. The number does not depend on the number of threads.
  std::shared_ptr<std::atomic<std::int64_t>> simulated{std::make_shared<std::atomic<std::int64_t>>(0)};
};

inline Eigen::Index dimension_of(const FitModel& model) {
  return static_cast<Eigen::Index>(model.ranges.size());
}

/// The range of the time offset.
inline CoordinateRange time_offset_range() {
  return {.low = -max_time_offset, .high = max_time_offset};
}

/// Fastest rate of the axis before it slides, of its oscillation or its damping, 1/s. It limits the steps of
/// a simulation.
double fastest_rate(const AxisParameters& parameters);

/// Modelled motion of a record.
struct RecordMotion {
  Eigen::VectorXd path;  ///< [sample] angle since the first sample, in the record's unit
  /// [sample, coordinate] Derivatives of `path`; 0 for coordinates that are not free.
  Eigen::MatrixXd sensitivity;
};

/// Path of a record, simulated to 0.01 of the record's unit. In a long hold of an evenly sampled record, once
/// only creep moves the rotor, the steps are longer and the samples are interpolated by cubics.
Eigen::VectorXd modelled_path(const TestRecord& record, const FitModel& model, const Point& point);

/// Motions of all records with their derivatives. The derivative with respect to the time offset comes from
/// the velocity, the others are forward differences. The records are simulated in parallel.
/// @param known empty, or the motions at this point with their paths and only the derivatives with respect to
/// the time offset
std::vector<RecordMotion> modelled_motions(Records records, const FitModel& model, const Point& point,
                                           const FreeCoordinates& free, std::vector<RecordMotion> known = {});

/// Samples that simulating all records at a point adds to FitModel::simulated.
std::int64_t samples_of_paths(Records records, const FitModel& model, const Point& point);

/// True if a fit whose prior has the mean `prior` may try the point. All coordinates must be within their
/// ranges. The motion must be at most 20 times as fast as the sampling, or at most twice as fast as the
/// motion at `prior`.
bool is_within_reach(Records records, const FitModel& model, const Point& prior, const Point& point);

/// True if the motion is at most `max_rate` times as fast as the sampling of every record. A faster motion
/// takes long to simulate, and the records do not determine it.
bool is_sampled(Records records, const FitModel& model, const Point& point, double max_rate = 20.0);

}  // namespace zerocount::fit

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
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
  std::string key;         ///< of its parameter in a manifest; empty: none
  std::string unit;        ///< on a rotary axis
  double value{0.0};       ///< at the fit: its logarithm, or itself
  Eigen::VectorXd slope;   ///< derivatives of `value` with respect to the coordinates
  bool logarithmic{true};  ///< whether `value` is a logarithm
};

/// A quantity whose logarithm is one of the coordinates.
Quantity coordinate_quantity(const std::string& name, const std::string& key, const std::string& unit,
                             const Point& point, Eigen::Index coordinate);

/// The time offset, the last coordinate.
Quantity time_offset_quantity(const Point& point);

/// Value and 95 % interval of a quantity, on its own scale (see Quantity::value).
struct QuantityEstimate {
  double value{0.0};
  double standard_error{0.0};
  double low{0.0};
  double high{0.0};

  double half_width() const { return 0.5 * (high - low); }
};

/// The interval of a quantity from the errors of replicates of the fit, multiplied by `widening` about their
/// mean.
/// @param errors [replicate, coordinate]; further columns are left out
QuantityEstimate interval_of_errors(const Quantity& quantity, const Eigen::MatrixXd& errors, double widening);

/// Largest half-width of a 95 % interval of a quantity that the records determine: of a logarithm a factor of
/// two to each side, of n or the time offset (samples) 1.
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
  double max_decrease{std::numeric_limits<double>::infinity()};  ///< from the mean of its prior
  double max_increase{std::numeric_limits<double>::infinity()};
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
};

/// A friction law as a function of coordinates that are fitted, and what is reported of a fit. Its motion is
/// that of core's Plant.
struct FitModel {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  std::vector<CoordinateRange> ranges;  ///< with that of the time offset, the last one
  FreeCoordinates free;                 ///< [coordinate] false for one that the law does not have
  std::function<AxisParameters(const Point&)> parameters_at;
  /// Compliance of a fixture in series with the contact, rad/(N m); empty: none.
  std::function<double(const Point&)> series_compliance{};
  std::function<std::vector<Quantity>(const Point&)> quantities_at;
  std::vector<Point> starts{};  ///< starting points of the fit
  /// Lines below `friction:` in a manifest for what is not fitted, with the units of a rotary axis; may be
  /// empty.
  std::function<std::string(const Point&)> fixed_lines{};
  /// The line `sliding_damping` below `plant:` where the records do not determine it; empty: no such line.
  std::string plant_lines{};
  /// Samples simulated with this model and its copies, each weighted by the steps that a fast rotor needs in
  /// it. The same for any number of threads.
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
  Eigen::VectorXd path;         ///< [sample] angle since the first sample, in the record's unit
  Eigen::MatrixXd sensitivity;  ///< [sample, coordinate] its derivatives; 0 for coordinates that are not free
};

/// The path of a record, simulated to 0.01 of the record's unit. When only creep moves the rotor in a long
/// hold of an evenly sampled record, the steps are longer and the samples are interpolated by cubics.
Eigen::VectorXd modelled_path(const TestRecord& record, const FitModel& model, const Point& point);

/// The motions of all records, with derivatives by forward differences, that with respect to the time offset
/// from the velocity. Simulated in parallel.
/// @param known empty, or these motions with their paths and the derivatives by the time offset alone
std::vector<RecordMotion> modelled_motions(Records records, const FitModel& model, const Point& point,
                                           const FreeCoordinates& free, std::vector<RecordMotion> known = {});

/// Samples that simulating all records at a point adds to FitModel::simulated.
std::int64_t samples_of_paths(Records records, const FitModel& model, const Point& point);

/// True if a fit whose prior has the mean `prior` may try the point: all coordinates within their ranges, and
/// the motion at most 20 times as fast as the sampling, or twice as fast as that of the prior.
bool is_within_reach(Records records, const FitModel& model, const Point& prior, const Point& point);

/// True if the motion is at most `max_rate` times as fast as the sampling of every record. A faster one takes
/// long to simulate, and cannot be told from the records.
bool is_sampled(Records records, const FitModel& model, const Point& point, double max_rate = 20.0);

}  // namespace zerocount::fit

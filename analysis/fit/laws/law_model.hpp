#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/fit/model.hpp"
#include "analysis/fit/presliding/contact.hpp"
#include "analysis/fit/record.hpp"
#include "core/friction/friction_model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::fit {

using LawPoint = Point;
using LawParameters = AxisParameters;

/// A friction law as a function of its coordinates: logarithms of its parameters (the exponent n of creep
/// itself), and last the time offset.
struct LawModel {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  AxisModel axis;
  FreeCoordinates free;  ///< [coordinate] false for one that the law does not have
  std::function<std::vector<Quantity>(const LawPoint&)> quantities_at;
  std::vector<LawPoint> starts;  ///< starting points of the fit
  /// Other starting points near a local minimum; may be empty.
  std::function<std::vector<LawPoint>(const LawPoint&)> neighbours{};
  /// Lines below `friction:` in a manifest for what is not fitted, with the units of a rotary axis.
  std::function<std::string(const LawPoint&)> fixed_lines;
  /// The line `sliding_damping` below `plant:` where the records do not determine it; empty: no such line.
  std::string plant_lines{};
};

/// Coordinates that a fit may change by a factor of 1000 each; the last one is the time offset.
std::vector<CoordinateRange> law_coordinates(std::size_t dimension);

/// Properties of the records from which the starting points follow.
struct RecordScales {
  ContactPoint contact;          ///< starting point of the pre-sliding model
  double creep_torque{1.0};      ///< σ0 of its coordinates, N m
  double largest_torque{0.0};    ///< N m
  double secant_stiffness{0.0};  ///< range of the torque over travel, N m/rad
  parameters::AxisKind axis{parameters::AxisKind::rotary};
};

RecordScales scales_of(Records records);

/// The laws that move before they slide, and can be fitted to records without sliding.
std::span<const friction::FrictionModel> fitted_laws();

/// The model of a law. `law` is one of fitted_laws().
LawModel law_model(friction::FrictionModel law, const RecordScales& scales, Records records);

/// The model with the compliance of a fixture, whose logarithm becomes the coordinate before the time offset:
/// the angle that is read is the rotor's plus compliance times torque.
LawModel with_series_compliance(const LawModel& model, const RecordScales& scales);

/// The models of the laws. Each has the rotor's inertia and damping beside the parameters of its contact.
LawModel presliding_model(const RecordScales& scales, Records records);
LawModel spring_model(const RecordScales& scales, Records records);
LawModel dahl_model(const RecordScales& scales, Records records);
LawModel lugre_model(const RecordScales& scales, Records records);
LawModel maxwell_slip_model(const RecordScales& scales);

}  // namespace zerocount::fit

#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/test_record.hpp"
#include "core/friction/friction_model.hpp"
#include "core/friction/parameters.hpp"
#include "core/motion/parameters.hpp"

namespace zerocount::law_identification {

using Records = std::span<const identification::TestRecord>;

/// The coordinates of a law: logarithms of its parameters (the exponent n of creep itself), and last the time
/// offset, the samples by which the torque acts later than recorded.
using LawPoint = Eigen::VectorXd;

/// A rotor with its friction.
struct LawParameters {
  motion::PlantParameters plant;
  friction::FrictionAlongRotor friction;
};

/// A quantity that is reported: a linear or nearly linear function of the coordinates.
struct LawQuantity {
  std::string name;
  std::string key;  ///< in a manifest; empty: none
  std::string unit;
  double value{0.0};       ///< its logarithm, or itself
  Eigen::VectorXd slope;   ///< derivatives of `value` with respect to the coordinates
  bool logarithmic{true};  ///< tells which of the two `value` is
};

/// A friction law as a function of its coordinates.
struct LawModel {
  friction::FrictionModel law{friction::FrictionModel::presliding};
  std::vector<bool> free;  ///< [coordinate] false for one that the law does not have
  std::function<LawParameters(const LawPoint&)> parameters_at;
  std::function<std::vector<LawQuantity>(const LawPoint&)> quantities_at;
  std::vector<LawPoint> starts;  ///< starting points of the fit
  /// Compliance of a fixture in series with the contact, rad/(N m); empty: none.
  std::function<double(const LawPoint&)> series_compliance{};
  /// Other starting points near a local minimum; may be empty.
  std::function<std::vector<LawPoint>(const LawPoint&)> neighbours{};
  /// Lines below `friction:` in a manifest for what is not fitted, with the units of a rotary axis.
  std::function<std::string(const LawPoint&)> fixed_lines;
  /// Such lines below `plant:`.
  std::string plant_lines{};
};

/// Properties of the records from which the starting points follow.
struct RecordScales {
  identification::ContactPoint contact;  ///< starting point of the pre-sliding model
  double creep_torque{1.0};              ///< σ0 of its coordinates, N m
  double largest_torque{0.0};            ///< N m
  double secant_stiffness{0.0};          ///< range of the torque over travel, N m/rad
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

/// Largest rate of the rotor's oscillation and damping before it slides, 1/s. It limits the steps of a
/// simulation.
double fastest_rate(const LawParameters& parameters);

/// A quantity that is one of the coordinates.
LawQuantity coordinate_quantity(const std::string& name, const std::string& key, const std::string& unit,
                                const LawPoint& point, Eigen::Index coordinate);

/// The time offset, the last coordinate.
LawQuantity time_offset_quantity(const LawPoint& point);

}  // namespace zerocount::law_identification

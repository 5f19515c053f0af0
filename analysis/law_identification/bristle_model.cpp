#include <cmath>

#include "analysis/identification/starting_values/starting_point.hpp"
#include "analysis/law_identification/law_model.hpp"

namespace zerocount::law_identification {
namespace {

/// Coordinates of a bristle with its rotor. Records without sliding show one level, g(0): the laws are fitted
/// with Fc = Fs.
enum BristleCoordinate : Eigen::Index {
  bristle_stiffness,  ///< ln σ0, of N m/rad
  bristle_level,      ///< q of Fs = T·(1 + exp q), with the largest torque T: the rotor does not slide
  bristle_damping,    ///< ln c (Dahl) or ln σ1 (LuGre), of N m s/rad
  bristle_inertia,    ///< ln J, of kg m²
  /// cs/(0.1·σ1) (LuGre): σ1 fades where the bristle yields, cs does not. Not a logarithm, which would be
  /// stuck near cs = 0.
  bristle_sliding_damping,
  bristle_offset,  ///< time offset, samples
  bristle_dimension
};

constexpr double sliding_damping_scale = 0.1;
constexpr double start_of_sliding_damping = 0.1;

/// Starting points over stiffness and level, each with the J and the damping that its ring-down shows.
std::vector<LawPoint> bristle_starts(const RecordScales& scales, Records records) {
  std::vector<LawPoint> starts;
  for (const double stiffness : {1.0, 1.4, 2.5}) {
    for (const double level : {1.05, 1.5, 3.0, 10.0}) {
      LawPoint start(bristle_dimension);
      const double sigma0 = stiffness * scales.secant_stiffness;
      const motion::PlantParameters plant = identification::estimate_ring_down(records, sigma0);
      start << std::log(sigma0), std::log(level - 1.0), std::log(plant.presliding_damping),
          std::log(plant.inertia), start_of_sliding_damping, 0.0;
      starts.push_back(start);
    }
  }
  return starts;
}

Quantity level_quantity(const LawPoint& point, double largest_torque) {
  Quantity level = coordinate_quantity("breakaway", "friction.breakaway", "N m", point, bristle_level);
  const double above = std::exp(point[bristle_level]);
  level.value = std::log(largest_torque * (1.0 + above));
  level.slope[bristle_level] = above / (1.0 + above);
  return level;
}

double sliding_damping_at(const LawPoint& point) {
  return sliding_damping_scale * std::exp(point[bristle_damping]) * point[bristle_sliding_damping];
}

Quantity sliding_damping_quantity(const LawPoint& point) {
  Quantity damping = coordinate_quantity("sliding_damping", "plant.sliding_damping", "N m s/rad", point,
                                         bristle_sliding_damping);
  damping.value = std::log(sliding_damping_at(point));
  damping.slope[bristle_sliding_damping] = 1.0 / point[bristle_sliding_damping];
  damping.slope[bristle_damping] = 1.0;
  return damping;
}

LawModel bristle_model(const RecordScales& scales, Records records, friction::FrictionModel law,
                       bool damped_bristle) {
  const double largest_torque = scales.largest_torque;
  LawModel model;
  model.law = law;
  model.axis.coordinates = law_coordinates(bristle_dimension);
  constexpr double least_sliding_damping = -3.0;  // a little below 0, so that a fit does not end there
  model.axis.coordinates[bristle_sliding_damping].low = least_sliding_damping;
  model.free.assign(bristle_dimension, true);
  model.free[bristle_sliding_damping] = damped_bristle;
  model.axis.parameters_at = [=](const LawPoint& point) {
    LawParameters parameters;
    if (damped_bristle) parameters.plant.sliding_damping = sliding_damping_at(point);
    parameters.friction.model = law;
    friction::FrictionParameters& contact = parameters.friction.uniform;
    contact.sigma0 = std::exp(point[bristle_stiffness]);
    contact.breakaway = largest_torque * (1.0 + std::exp(point[bristle_level]));
    contact.coulomb_ratio = 1.0;
    (damped_bristle ? contact.sigma1 : parameters.plant.presliding_damping) =
        std::exp(point[bristle_damping]);
    parameters.plant.inertia = std::exp(point[bristle_inertia]);
    return parameters;
  };
  model.quantities_at = [=](const LawPoint& point) {
    std::vector<Quantity> quantities{
        coordinate_quantity("sigma0", "friction.sigma0", "N m/rad", point, bristle_stiffness),
        level_quantity(point, largest_torque),
        damped_bristle ? coordinate_quantity("sigma1", "friction.sigma1", "N m s/rad", point, bristle_damping)
                       : coordinate_quantity("presliding_damping", "plant.presliding_damping", "N m s/rad",
                                             point, bristle_damping),
        coordinate_quantity("inertia", "plant.inertia", "kg m^2", point, bristle_inertia),
        time_offset_quantity(point)};
    if (damped_bristle) quantities.insert(quantities.end() - 1, sliding_damping_quantity(point));
    return quantities;
  };
  model.starts = bristle_starts(scales, records);
  model.fixed_lines = [](const LawPoint&) {
    return std::string("  coulomb_ratio: 1.0   # given: records without sliding show one level only\n");
  };
  if (damped_bristle)
    model.plant_lines = "  sliding_damping: 0   # given: before it slides, sigma1 stands for both\n";
  return model;
}

}  // namespace

LawModel dahl_model(const RecordScales& scales, Records records) {
  return bristle_model(scales, records, friction::FrictionModel::dahl, false);
}

LawModel lugre_model(const RecordScales& scales, Records records) {
  return bristle_model(scales, records, friction::FrictionModel::lugre, true);
}

}  // namespace zerocount::law_identification

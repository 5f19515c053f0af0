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
  bristle_offset,     ///< time offset, samples
  bristle_dimension
};

/// Starting points over stiffness and level, each with the J and the damping that its ring-down shows.
std::vector<LawPoint> bristle_starts(const RecordScales& scales, Records records) {
  std::vector<LawPoint> starts;
  for (const double stiffness : {1.0, 1.4, 2.5}) {
    for (const double level : {1.05, 1.5, 3.0, 10.0}) {
      LawPoint start(bristle_dimension);
      const double sigma0 = stiffness * scales.secant_stiffness;
      const motion::PlantParameters plant = identification::estimate_ring_down(records, sigma0);
      start << std::log(sigma0), std::log(level - 1.0), std::log(plant.presliding_damping),
          std::log(plant.inertia), 0.0;
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

LawModel bristle_model(const RecordScales& scales, Records records, friction::FrictionModel law,
                       bool damped_bristle) {
  const double largest_torque = scales.largest_torque;
  // Before it slides, the sliding damping of lugre cannot be told from σ1.
  const bool has_default = scales.axis == parameters::AxisKind::rotary || !damped_bristle;
  const double sliding_damping = has_default ? motion::PlantParameters{}.sliding_damping : 0.0;
  LawModel model;
  model.law = law;
  model.axis.coordinates = law_coordinates(bristle_dimension);
  model.free.assign(bristle_dimension, true);
  model.axis.parameters_at = [=](const LawPoint& point) {
    LawParameters parameters;
    parameters.plant.sliding_damping = sliding_damping;
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
    return std::vector<Quantity>{
        coordinate_quantity("sigma0", "friction.sigma0", "N m/rad", point, bristle_stiffness),
        level_quantity(point, largest_torque),
        damped_bristle ? coordinate_quantity("sigma1", "friction.sigma1", "N m s/rad", point, bristle_damping)
                       : coordinate_quantity("presliding_damping", "plant.presliding_damping", "N m s/rad",
                                             point, bristle_damping),
        coordinate_quantity("inertia", "plant.inertia", "kg m^2", point, bristle_inertia),
        time_offset_quantity(point)};
  };
  model.starts = bristle_starts(scales, records);
  model.fixed_lines = [](const LawPoint&) {
    return std::string("  coulomb_ratio: 1.0   # given: records without sliding show one level only\n");
  };
  if (!has_default)
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

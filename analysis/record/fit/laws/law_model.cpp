#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"
#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {
namespace {

using friction::FrictionModel;

/// The fit model of the pre-sliding law, with creep or without.
FitModel spring_based_model(const RecordScales& scales, Records records, friction::FrictionModel law) {
  const bool creeps = friction::has_creep(law);
  FitModel model = contact_model(scales.creep_torque);
  model.law = law;
  model.ranges = law_coordinates(coordinate_count);
  for (const Coordinate j : {log_alpha, log_limit, creep_exponent}) model.free[j] = creeps;
  model.parameters_at = [law, of_contact = model.parameters_at](const Point& point) {
    AxisParameters parameters = of_contact(point);
    parameters.friction.model = law;
    return parameters;
  };
  model.quantities_at = [creeps, of_contact = model.quantities_at](const Point& point) {
    std::vector<Quantity> quantities = of_contact(point);
    std::erase_if(quantities, [&](const Quantity& quantity) {
      const Coordinate coordinate = coordinate_of(quantity);
      return quantity.name == "k1_plus_k2" ||
             (!creeps && coordinate >= log_alpha && coordinate <= creep_exponent);
    });
    return quantities;
  };
  model.starts = starts_with_other_softening(records, scales.contact, scales.creep_torque);
  model.starts.insert(model.starts.begin(), scales.contact);
  return model;
}

/// Coordinates (fitted unknowns) of a bristle model, Dahl or LuGre, with its rotor. Records without sliding
/// show only one friction level, g(0): the laws are fitted with Coulomb friction Fc equal to static friction
/// Fs.
enum BristleCoordinate : Eigen::Index {
  bristle_stiffness,  ///< ln σ0: logarithm of the bristle stiffness in N m/rad
  /// q in Fs = T·(1 + exp q): static friction Fs above the largest torque T of the records, so that the rotor
  /// does not slide
  bristle_level,
  bristle_damping,  ///< logarithm of the damping in N m s/rad: c (Dahl), or σ1 of the bristle (LuGre)
  bristle_inertia,  ///< ln J: logarithm of the inertia in kg m²
  /// LuGre only: ratio cs/(0.1·σ1) of the sliding damping cs to the bristle damping σ1. σ1 fades where the
  /// bristle yields, cs does not. Not a logarithm, because a fit would be stuck near cs = 0.
  bristle_sliding_damping,
  bristle_offset,  ///< time by which the torque acts later than recorded, samples
  bristle_dimension
};

constexpr double sliding_damping_scale = 0.1;
constexpr double start_of_sliding_damping = 0.1;

/// Starting points of a fit over a grid of stiffness and friction level, each with the inertia J and the
/// damping that its ring-down shows.
std::vector<Point> bristle_starts(const RecordScales& scales, Records records) {
  std::vector<Point> starts;
  for (const double stiffness : {1.0, 1.4, 2.5}) {
    for (const double level : {1.05, 1.5, 3.0, 10.0}) {
      Point start(bristle_dimension);
      const double sigma0 = stiffness * scales.secant_stiffness;
      const motion::PlantParameters plant = estimate_ring_down(records, sigma0);
      start << std::log(sigma0), std::log(level - 1.0), std::log(plant.presliding_damping),
          std::log(plant.inertia), start_of_sliding_damping, 0.0;
      starts.push_back(start);
    }
  }
  return starts;
}

Quantity level_quantity(const Point& point, double largest_torque) {
  Quantity level =
      coordinate_quantity("breakaway", parameter::friction::breakaway, "N m", point, bristle_level);
  const double above = std::exp(point[bristle_level]);
  level.value = std::log(largest_torque * (1.0 + above));
  level.slope[bristle_level] = above / (1.0 + above);
  return level;
}

double sliding_damping_at(const Point& point) {
  return sliding_damping_scale * std::exp(point[bristle_damping]) * point[bristle_sliding_damping];
}

Quantity sliding_damping_quantity(const Point& point) {
  Quantity damping = coordinate_quantity("sliding_damping", parameter::plant::sliding_damping, "N m s/rad",
                                         point, bristle_sliding_damping);
  damping.value = std::log(sliding_damping_at(point));
  damping.slope[bristle_sliding_damping] = 1.0 / point[bristle_sliding_damping];
  damping.slope[bristle_damping] = 1.0;
  return damping;
}

FitModel bristle_model(const RecordScales& scales, Records records, friction::FrictionModel law) {
  const bool damped_bristle = law == FrictionModel::lugre;
  const double largest_torque = scales.largest_torque;
  FitModel model;
  model.law = law;
  model.ranges = law_coordinates(bristle_dimension);
  constexpr double least_sliding_damping = -3.0;  // a little below 0, so that a fit does not end there
  model.ranges[bristle_sliding_damping].low = least_sliding_damping;
  model.free.assign(bristle_dimension, true);
  model.free[bristle_sliding_damping] = damped_bristle;
  model.parameters_at = [=](const Point& point) {
    AxisParameters parameters;
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
  model.quantities_at = [=](const Point& point) {
    std::vector<Quantity> quantities{
        coordinate_quantity("sigma0", parameter::friction::sigma0, "N m/rad", point, bristle_stiffness),
        level_quantity(point, largest_torque),
        damped_bristle
            ? coordinate_quantity("sigma1", parameter::friction::sigma1, "N m s/rad", point, bristle_damping)
            : coordinate_quantity("presliding_damping", parameter::plant::presliding_damping, "N m s/rad",
                                  point, bristle_damping),
        coordinate_quantity("inertia", parameter::plant::inertia, "kg m^2", point, bristle_inertia),
        time_offset_quantity(point)};
    if (damped_bristle) quantities.insert(quantities.end() - 1, sliding_damping_quantity(point));
    return quantities;
  };
  model.starts = bristle_starts(scales, records);
  model.fixed_lines = [](const Point&) {
    return std::string("  coulomb_ratio: 1.0   # given: records without sliding show one level only\n");
  };
  if (damped_bristle)
    model.plant_lines = "  sliding_damping: 0   # given: before it slides, sigma1 stands for both\n";
  return model;
}

}  // namespace

FitModel law_model(FrictionModel law, const RecordScales& scales, Records records) {
  switch (law) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return spring_based_model(scales, records, law);
    case FrictionModel::dahl:
    case FrictionModel::lugre:
      return bristle_model(scales, records, law);
    case FrictionModel::gms:
      return maxwell_slip_model(scales, records);
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  throw std::invalid_argument("a law without motion before it slides");
}

FitModel with_series_compliance(FitModel model, const RecordScales& scales) {
  const auto before_offset = [](auto& values, const auto& value) { values.insert(values.end() - 1, value); };
  before_offset(model.free, true);
  before_offset(model.ranges, model.ranges.front());
  model.series_compliance = [](const Point& point) { return std::exp(point[point.size() - 2]); };
  model.quantities_at = [=, of_law = model.quantities_at](const Point& point) {
    std::vector<Quantity> quantities = of_law(point);
    before_offset(quantities,
                  coordinate_quantity("series_compliance", "", "rad/(N m)", point, point.size() - 2));
    return quantities;
  };
  std::vector<Point> starts;
  for (const double part : {0.02, 0.3}) {  // of the travel
    for (const Point& start : model.starts) {
      Point& point = starts.emplace_back(start.size() + 1);
      point << start.head(start.size() - 1), std::log(part / scales.secant_stiffness), start.tail<1>();
    }
  }
  model.starts = std::move(starts);
  return model;
}

}  // namespace zerocount::fit

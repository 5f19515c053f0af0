#include "analysis/fit/laws/law_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "analysis/fit/presliding/contact.hpp"
#include "analysis/fit/presliding/contact_fit.hpp"
#include "analysis/fit/presliding/starting_point.hpp"
#include "core/friction/law.hpp"

namespace zerocount::fit {

namespace {

using friction::FrictionModel;

constexpr std::array laws_with_motion{FrictionModel::presliding, FrictionModel::spring, FrictionModel::dahl,
                                      FrictionModel::lugre, FrictionModel::gms};

}  // namespace

RecordScales scales_of(Records records) {
  RecordScales scales;
  scales.axis = records.front().axis;
  scales.creep_torque = creep_torque_for(records, {});
  const FreeCoordinates free(coordinate_count, true);
  // That of closed forms, without a creep that was fitted to slow parts.
  scales.contact = starting_points(records, scales.creep_torque, ContactPoint::Zero(), free).back();
  for (const TestRecord& record : records) {
    const Eigen::VectorXd angle = measured_angle(record);
    scales.largest_torque = std::max(scales.largest_torque, largest_torque(record));
    scales.secant_stiffness =
        std::max(scales.secant_stiffness, torque_range(record) / (angle.maxCoeff() - angle.minCoeff()));
  }
  return scales;
}

std::span<const FrictionModel> fitted_laws() {
  return laws_with_motion;
}

LawModel law_model(FrictionModel law, const RecordScales& scales, Records records) {
  switch (law) {
    case FrictionModel::presliding:
      return presliding_model(scales, records);
    case FrictionModel::spring:
      return spring_model(scales, records);
    case FrictionModel::dahl:
      return dahl_model(scales, records);
    case FrictionModel::lugre:
      return lugre_model(scales, records);
    case FrictionModel::gms:
      return maxwell_slip_model(scales);
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  throw std::invalid_argument("a law without motion before it slides");
}

std::vector<CoordinateRange> law_coordinates(std::size_t dimension) {
  constexpr double max_change = 6.9;
  std::vector<CoordinateRange> ranges(dimension, {.max_decrease = max_change, .max_increase = max_change});
  ranges.back() = time_offset_range();
  return ranges;
}

namespace {

/// The pre-sliding model in the coordinates of contact_at().
LawModel spring_based_model(const RecordScales& scales, Records records, friction::FrictionModel law,
                            bool creeps) {
  const double creep_torque = scales.creep_torque;
  LawModel model;
  model.law = law;
  model.axis.coordinates = law_coordinates(coordinate_count);
  model.free.assign(coordinate_count, true);
  if (!creeps) {
    for (const Coordinate j : {log_alpha, log_limit, creep_exponent}) model.free[j] = false;
  }
  model.axis.parameters_at = [=](const LawPoint& point) {
    const ContactParameters contact = contact_at(point, creep_torque);
    return LawParameters{contact.plant, {.uniform = contact.friction, .profiled = {}, .model = law}};
  };
  model.quantities_at = [=](const LawPoint& point) {
    std::vector<Quantity> quantities;
    for (const Quantity& quantity : fitted_quantities(point, creep_torque)) {
      const Coordinate coordinate = coordinate_of(quantity);
      if (quantity.name == "k1_plus_k2") continue;
      if (!creeps && coordinate >= log_alpha && coordinate != time_offset) continue;
      quantities.push_back(quantity);
    }
    return quantities;
  };
  model.starts.push_back(scales.contact);
  for (const ContactPoint& other : starts_with_other_softening(records, scales.contact, creep_torque)) {
    model.starts.push_back(other);
  }
  model.fixed_lines = [](const LawPoint&) { return std::string(); };
  return model;
}

}  // namespace

LawModel presliding_model(const RecordScales& scales, Records records) {
  return spring_based_model(scales, records, friction::FrictionModel::presliding, true);
}

LawModel spring_model(const RecordScales& scales, Records records) {
  return spring_based_model(scales, records, friction::FrictionModel::spring, false);
}

namespace {

/// The point of the law alone: without the coordinate before the time offset.
LawPoint without_compliance(const LawPoint& point) {
  LawPoint law = point.head(point.size() - 1);
  law[law.size() - 1] = point[point.size() - 1];
  return law;
}

LawPoint with_compliance(const LawPoint& law, double logarithm) {
  LawPoint point(law.size() + 1);
  point << law.head(law.size() - 1), logarithm, law[law.size() - 1];
  return point;
}

/// The slope of a quantity of the law alone with respect to all coordinates.
Quantity widened(Quantity quantity) {
  quantity.slope = with_compliance(quantity.slope, 0.0);
  return quantity;
}

}  // namespace

LawModel with_series_compliance(const LawModel& law, const RecordScales& scales) {
  LawModel model = law;
  model.free.insert(model.free.end() - 1, true);
  model.axis.coordinates = law_coordinates(model.free.size());
  model.axis.parameters_at = [law](const LawPoint& point) {
    return law.axis.parameters_at(without_compliance(point));
  };
  model.fixed_lines = [law](const LawPoint& point) { return law.fixed_lines(without_compliance(point)); };
  model.axis.series_compliance = [](const LawPoint& point) { return std::exp(point[point.size() - 2]); };
  model.quantities_at = [law](const LawPoint& point) {
    std::vector<Quantity> quantities;
    for (Quantity& quantity : law.quantities_at(without_compliance(point))) {
      quantities.push_back(widened(std::move(quantity)));
    }
    quantities.insert(quantities.end() - 1,
                      coordinate_quantity("series_compliance", "", "rad/(N m)", point, point.size() - 2));
    return quantities;
  };
  model.starts.clear();
  for (const double part : {0.02, 0.3}) {  // of the travel
    for (const LawPoint& start : law.starts) {
      model.starts.push_back(with_compliance(start, std::log(part / scales.secant_stiffness)));
    }
  }
  if (law.neighbours) {
    model.neighbours = [law](const LawPoint& point) {
      std::vector<LawPoint> others;
      for (const LawPoint& other : law.neighbours(without_compliance(point))) {
        others.push_back(with_compliance(other, point[point.size() - 2]));
      }
      return others;
    };
  }
  return model;
}

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
      const motion::PlantParameters plant = estimate_ring_down(records, sigma0);
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

}  // namespace zerocount::fit

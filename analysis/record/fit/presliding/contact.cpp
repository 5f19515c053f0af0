#include "analysis/record/fit/presliding/contact.hpp"

#include <cmath>

namespace zerocount::fit {
namespace {

/// Breakaway torque of a fitted contact, in multiples of the torque scale σ0: above all torques of a record,
/// so that the contact never slides.
constexpr double breakaway_factor = 1e3;

/// A reported quantity that is a coordinate of the fit itself, not its exponential.
Quantity of_coordinate(const std::string& name, const std::string& unit, Coordinate coordinate,
                       const Point& point) {
  return coordinate_quantity(name, std::string(coordinate_keys[coordinate]), unit, point, coordinate);
}

Quantity sum_of_stiffnesses(const Point& point) {
  const double k1 = std::exp(point[log_k1]);
  const double k2 = std::exp(point[log_k2]);
  Quantity quantity = coordinate_quantity("k1_plus_k2", "", "N m/rad", point, log_k1);
  quantity.value = std::log(k1 + k2);
  quantity.slope[log_k1] = k1 / (k1 + k2);
  quantity.slope[log_k2] = k2 / (k1 + k2);
  return quantity;
}

Quantity hardening_modulus(const Point& point, double creep_torque) {
  const double logarithm = std::log(creep_torque);
  Quantity quantity = of_coordinate("lambda", "(N m)^n/rad", log_limit, point);
  quantity.value = point[creep_exponent] * logarithm - point[log_limit];
  quantity.slope[log_limit] = -1.0;
  quantity.slope[creep_exponent] = logarithm;
  return quantity;
}

std::vector<Quantity> fitted_quantities(const Point& point, double creep_torque) {
  Quantity exponent = of_coordinate("n", "1", creep_exponent, point);
  exponent.logarithmic = false;
  return {of_coordinate("k1", "N m/rad", log_k1, point),
          of_coordinate("k2", "N m/rad", log_k2, point),
          sum_of_stiffnesses(point),
          of_coordinate("beta", "1/rad", log_beta, point),
          of_coordinate("presliding_damping", "N m s/rad", log_damping, point),
          of_coordinate("inertia", "kg m^2", log_inertia, point),
          of_coordinate("alpha", "1/s", log_alpha, point),
          hardening_modulus(point, creep_torque),
          exponent,
          time_offset_quantity(point)};
}

}  // namespace

ContactParameters contact_at(const Point& point, double creep_torque) {
  ContactParameters contact;
  contact.friction.k1 = std::exp(point[log_k1]);
  contact.friction.k2 = std::exp(point[log_k2]);
  contact.friction.beta = std::exp(point[log_beta]);
  contact.plant.presliding_damping = std::exp(point[log_damping]);
  contact.plant.inertia = std::exp(point[log_inertia]);
  contact.friction.alpha = std::exp(point[log_alpha]);
  contact.friction.n = point[creep_exponent];
  contact.friction.lambda = std::exp(contact.friction.n * std::log(creep_torque) - point[log_limit]);
  contact.friction.breakaway = breakaway_factor * creep_torque;
  return contact;
}

FitModel contact_model(double creep_torque) {
  // Far beyond, simulations become very slow. The limit of creep may vanish, which does not slow them.
  constexpr double max_change = 4.6;  // a factor of 100
  constexpr double max_creep_decrease = 14.0;
  constexpr double min_exponent = 0.2;
  constexpr double max_exponent = 20.0;
  FitModel model;
  model.free.assign(coordinate_count, true);
  model.ranges.assign(coordinate_count, {.max_decrease = max_change, .max_increase = max_change});
  model.ranges[log_limit].max_decrease = max_creep_decrease;
  model.ranges[creep_exponent] = {.low = min_exponent, .high = max_exponent};
  model.ranges[time_offset] = time_offset_range();
  model.parameters_at = [creep_torque](const Point& point) {
    const ContactParameters contact = contact_at(point, creep_torque);
    return AxisParameters{contact.plant, {contact.friction, {}}};
  };
  model.quantities_at = [creep_torque](const Point& point) { return fitted_quantities(point, creep_torque); };
  return model;
}

Point point_of(const ContactParameters& contact, double creep_torque) {
  Point point = Point::Zero(coordinate_count);
  point[log_k1] = std::log(contact.friction.k1);
  point[log_k2] = std::log(contact.friction.k2);
  point[log_beta] = std::log(contact.friction.beta);
  point[log_damping] = std::log(contact.plant.presliding_damping);
  point[log_inertia] = std::log(contact.plant.inertia);
  point[log_alpha] = std::log(contact.friction.alpha);
  point[creep_exponent] = contact.friction.n;
  point[log_limit] = contact.friction.n * std::log(creep_torque) - std::log(contact.friction.lambda);
  return point;
}

}  // namespace zerocount::fit

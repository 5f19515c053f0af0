#include "analysis/identification/contact_coordinates.hpp"

#include <cmath>

namespace zerocount::identification {
namespace {

/// Breakaway torque in multiples of σ0, above all torques of a record, so that the hook never slides.
constexpr double breakaway_factor = 1e3;

}  // namespace

ContactParameters contact_at(const ContactPoint& point, double creep_torque) {
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

record_fit::AxisModel contact_model(double creep_torque) {
  // Far beyond, simulations become very slow. The limit of creep may vanish, which does not slow them.
  constexpr double max_change = 4.6;  // a factor of 100
  constexpr double max_creep_decrease = 14.0;
  constexpr double min_exponent = 0.2;
  constexpr double max_exponent = 20.0;
  record_fit::AxisModel model;
  model.coordinates.assign(coordinate_count, {.max_decrease = max_change, .max_increase = max_change});
  model.coordinates[log_limit].max_decrease = max_creep_decrease;
  model.coordinates[creep_exponent] = {.low = min_exponent, .high = max_exponent};
  model.coordinates[time_offset] = record_fit::time_offset_range();
  model.parameters_at = [creep_torque](const record_fit::Point& point) {
    const ContactParameters contact = contact_at(point, creep_torque);
    return record_fit::AxisParameters{contact.plant, {contact.friction, {}}};
  };
  return model;
}

ContactPoint point_of(const ContactParameters& contact, double creep_torque) {
  ContactPoint point = ContactPoint::Zero();
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

}  // namespace zerocount::identification

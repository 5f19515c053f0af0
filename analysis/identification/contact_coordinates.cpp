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

#include "analysis/law_identification/law_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/starting_point.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {
namespace {

using friction::FrictionModel;

/// Stiffness of the contact after a reversal, N m/rad.
double largest_stiffness(const friction::FrictionAlongRotor& friction) {
  const friction::FrictionParameters& contact = friction.uniform;
  switch (friction.model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return contact.k1 + contact.k2;
    case FrictionModel::dahl:
    case FrictionModel::lugre:
      return contact.sigma0;
    case FrictionModel::gms:
      return std::accumulate(
          friction.gms_elements.begin(), friction.gms_elements.end(), 0.0,
          [](double sum, const friction::GmsElement& element) { return sum + element.stiffness; });
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  return 0.0;
}

/// Damping before it slides, N m s/rad.
double presliding_damping(const LawParameters& parameters) {
  const friction::LawTraits& law = friction::traits_of(parameters.friction.model);
  double damping = law.has_presliding_damping ? parameters.plant.presliding_damping : 0.0;
  if (law.has_sliding_damping && !law.has_presliding_damping) damping += parameters.plant.sliding_damping;
  if (parameters.friction.model == FrictionModel::lugre) damping += parameters.friction.uniform.sigma1;
  return damping;
}

constexpr std::array laws_with_motion{FrictionModel::presliding, FrictionModel::spring, FrictionModel::dahl,
                                      FrictionModel::lugre, FrictionModel::gms};

}  // namespace

RecordScales scales_of(Records records) {
  RecordScales scales;
  scales.axis = records.front().axis;
  scales.creep_torque = identification::creep_torque_for(records, {});
  identification::FreeCoordinates free;
  free.fill(true);
  scales.contact = identification::starting_point(records, scales.creep_torque,
                                                  identification::ContactPoint::Zero(), free);
  scales.contact[identification::time_offset] = 0.0;
  for (const identification::TestRecord& record : records) {
    const Eigen::VectorXd angle = identification::measured_angle(record);
    scales.largest_torque = std::max(scales.largest_torque, identification::largest_torque(record));
    scales.secant_stiffness = std::max(scales.secant_stiffness, identification::torque_range(record) /
                                                                    (angle.maxCoeff() - angle.minCoeff()));
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

double fastest_rate(const LawParameters& parameters) {
  return std::max(std::sqrt(largest_stiffness(parameters.friction) / parameters.plant.inertia),
                  presliding_damping(parameters) / parameters.plant.inertia);
}

LawQuantity coordinate_quantity(const std::string& name, const std::string& key, const std::string& unit,
                                const LawPoint& point, Eigen::Index coordinate) {
  LawQuantity quantity{name, key, unit, point[coordinate], Eigen::VectorXd::Zero(point.size()), true};
  quantity.slope[coordinate] = 1.0;
  return quantity;
}

LawQuantity time_offset_quantity(const LawPoint& point) {
  LawQuantity quantity = coordinate_quantity("time_offset", "", "samples", point, point.size() - 1);
  quantity.logarithmic = false;
  return quantity;
}

}  // namespace zerocount::law_identification

#include "analysis/law_identification/law_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/starting_values/starting_point.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {
namespace {

using friction::FrictionModel;

constexpr std::array laws_with_motion{FrictionModel::presliding, FrictionModel::spring, FrictionModel::dahl,
                                      FrictionModel::lugre, FrictionModel::gms};

}  // namespace

RecordScales scales_of(Records records) {
  RecordScales scales;
  scales.axis = records.front().axis;
  scales.creep_torque = identification::creep_torque_for(records, {});
  const record_fit::FreeCoordinates free(identification::coordinate_count, true);
  // That of closed forms, without a creep that was fitted to slow parts.
  scales.contact = identification::starting_points(records, scales.creep_torque,
                                                   identification::ContactPoint::Zero(), free)
                       .back();
  for (const TestRecord& record : records) {
    const Eigen::VectorXd angle = identification::measured_angle(record);
    scales.largest_torque = std::max(scales.largest_torque, record_fit::largest_torque(record));
    scales.secant_stiffness = std::max(
        scales.secant_stiffness, record_fit::torque_range(record) / (angle.maxCoeff() - angle.minCoeff()));
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

std::vector<record_fit::CoordinateRange> law_coordinates(std::size_t dimension) {
  constexpr double max_change = 6.9;
  std::vector<record_fit::CoordinateRange> ranges(dimension,
                                                  {.max_decrease = max_change, .max_increase = max_change});
  ranges.back() = record_fit::time_offset_range();
  return ranges;
}

}  // namespace zerocount::law_identification

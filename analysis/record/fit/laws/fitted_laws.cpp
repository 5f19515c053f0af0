#include <algorithm>
#include <array>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"
#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {
namespace {

using friction::FrictionModel;

constexpr std::array laws_with_motion{FrictionModel::presliding, FrictionModel::spring, FrictionModel::dahl,
                                      FrictionModel::lugre, FrictionModel::gms};

}  // namespace

RecordScales scales_of(Records records) {
  RecordScales scales;
  scales.creep_torque = creep_torque_for(records, {});
  const FreeCoordinates free(coordinate_count, true);
  // That of closed forms, without a creep that was fitted to slow parts.
  scales.contact = starting_points(records, scales.creep_torque, Point::Zero(coordinate_count), free).back();
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

std::vector<CoordinateRange> law_coordinates(std::size_t dimension) {
  constexpr double max_change = 6.9;
  std::vector<CoordinateRange> ranges(dimension, {.max_decrease = max_change, .max_increase = max_change});
  ranges.back() = time_offset_range();
  return ranges;
}

}  // namespace zerocount::fit

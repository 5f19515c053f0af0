#include "analysis/identification/confidence_interval.hpp"
#include "analysis/identification/starting_values/starting_point.hpp"
#include "analysis/law_identification/law_model.hpp"

namespace zerocount::law_identification {
namespace {

namespace id = identification;

/// The pre-sliding model in the coordinates of identification::contact_at().
LawModel spring_based_model(const RecordScales& scales, Records records, friction::FrictionModel law,
                            bool creeps) {
  const double creep_torque = scales.creep_torque;
  LawModel model;
  model.law = law;
  model.axis.coordinates = law_coordinates(id::coordinate_count);
  model.free.assign(id::coordinate_count, true);
  if (!creeps) {
    for (const id::Coordinate j : {id::log_alpha, id::log_limit, id::creep_exponent}) model.free[j] = false;
  }
  model.axis.parameters_at = [=](const LawPoint& point) {
    const id::ContactParameters contact = id::contact_at(point, creep_torque);
    return LawParameters{contact.plant, {.uniform = contact.friction, .profiled = {}, .model = law}};
  };
  model.quantities_at = [=](const LawPoint& point) {
    std::vector<Quantity> quantities;
    for (const Quantity& quantity : id::fitted_quantities(point, creep_torque)) {
      const id::Coordinate coordinate = id::coordinate_of(quantity);
      if (quantity.name == "k1_plus_k2") continue;
      if (!creeps && coordinate >= id::log_alpha && coordinate != id::time_offset) continue;
      quantities.push_back(quantity);
    }
    return quantities;
  };
  model.starts.push_back(scales.contact);
  for (const id::ContactPoint& other :
       id::starts_with_other_softening(records, scales.contact, creep_torque)) {
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

}  // namespace zerocount::law_identification

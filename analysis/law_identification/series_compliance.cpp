#include <cmath>

#include "analysis/law_identification/law_model.hpp"

namespace zerocount::law_identification {
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

}  // namespace zerocount::law_identification

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"
#include "core/numerics/dense.hpp"
#include "experiments/parameters/handles.hpp"

namespace zerocount::fit {

namespace {

/// Number of elements that slip, in the order of the travel at which they do. One more element sticks
/// throughout.
constexpr std::size_t slipping_elements = 3;

/// Coordinates of the fit, in this order: stiffness of all elements (ln κ, of N m/rad); travel at which the
/// slipping ones slip (ln of rad); damping (ln cs, of N m s/rad); inertia (ln J, of kg m²); time offset
/// (samples). This constant is the index of the first travel.
constexpr Eigen::Index element_travel = slipping_elements + 1;
constexpr Eigen::Index element_damping = element_travel + slipping_elements;
constexpr Eigen::Index element_inertia = element_damping + 1;
constexpr Eigen::Index element_dimension = element_inertia + 2;

/// Friction level of the sticking element as a multiple of the largest torque of the records, so that it is
/// never reached.
constexpr double never_reached = 10.0;

/// Attraction parameter C of the slipping elements, N m/s. At the torques of the paper it is the default of a
/// manifest.
/// @param largest_torque largest |torque| of the records, N m
double attraction_at(double largest_torque) {
  constexpr double rate = 200.0;  // 1/s
  return rate * largest_torque;
}

/// The friction levels W (torques at which they slip) of the elements at the point, N m.
std::vector<double> levels_at(const Point& point, double largest_torque) {
  std::vector<double> levels;
  for (std::size_t i = 0; i < slipping_elements; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    levels.push_back(std::exp(point[at] + point[element_travel + at]));
  }
  levels.push_back(never_reached * largest_torque);
  return levels;
}

std::vector<friction::GmsElement> elements_at(const Point& point, const std::vector<double>& levels) {
  const double all = std::accumulate(levels.begin(), levels.end(), 0.0);
  std::vector<friction::GmsElement> elements;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    elements.push_back({std::exp(point[static_cast<Eigen::Index>(i)]), levels[i] / all});
  }
  return elements;
}

/// Candidate travels at which elements may slip, from a thousandth of the records' range to half of it, rad.
Eigen::VectorXd possible_travels(Records records) {
  constexpr Eigen::Index count = 24;
  constexpr double smallest = 1e-3;
  double range = 0.0;
  for (const TestRecord& record : records) {
    const auto [low, high] = std::ranges::minmax(record.reading);
    range = std::max(range, record.unit * (high - low));
  }
  return range * Eigen::ArrayXd::LinSpaced(count, std::log(smallest), std::log(0.5)).exp();
}

/// Normal equations of the torque along the measured path: J·d²θ/dt² + c·dθ/dt + Σ κ_i·z_i, in which the
/// strain z_i of an element follows the axis within ± its slip travel. With the travels, J and c given, it is
/// linear in κ (equation error; Rizos & Fassois, Chaos 14, 2004, 431).
struct TorqueAlongPath {
  /// Products of the strains of all possible elements with each other; the sticking element is the last one.
  Eigen::MatrixXd strains;
  /// Products of the strains of all possible elements with the torque that the elements together carry.
  Eigen::VectorXd torque;
};

TorqueAlongPath torque_along_path(Records records, const Eigen::VectorXd& travels,
                                  const motion::PlantParameters& plant) {
  const auto elements = travels.size() + 1;
  TorqueAlongPath sums{Eigen::MatrixXd::Zero(elements, elements), Eigen::VectorXd::Zero(elements)};
  for (const TestRecord& record : records) {
    const Eigen::VectorXd angle = measured_angle(record);
    Eigen::VectorXd strain = Eigen::VectorXd::Zero(elements);
    for (Eigen::Index k = 1; k + 1 < angle.size(); ++k) {
      const auto sample = static_cast<std::size_t>(k);
      const double moved = angle[k] - angle[k - 1];
      strain.array() += moved;
      strain.head(travels.size()) = strain.head(travels.size()).cwiseMin(travels).cwiseMax(-travels);
      const double interval = interval_after(record, sample);
      const double velocity = 0.5 * (angle[k + 1] - angle[k - 1]) / interval;
      const double acceleration = (angle[k + 1] - 2.0 * angle[k] + angle[k - 1]) / (interval * interval);
      const double applied = 0.5 * (record.torque[sample - 1].now + record.torque[sample].now);
      const double carried = applied - plant.presliding_damping * velocity - plant.inertia * acceleration;
      sums.strains += strain * strain.transpose();
      sums.torque += carried * strain;
    }
  }
  return sums;
}

/// Starting points with the elements whose torque along the measured path is closest to the applied torque,
/// one for each smallest slip travel. No element is softer than a thousandth of the stiffest, because a fit
/// could not make it stiffer again.
std::vector<Point> nearest_elements(const RecordScales& scales, Records records) {
  constexpr double faint = 1e-3;
  const motion::PlantParameters plant = contact_at(scales.contact, scales.creep_torque).plant;
  const Eigen::VectorXd travels = possible_travels(records);
  const TorqueAlongPath path = torque_along_path(records, travels, plant);
  const Eigen::Index count = travels.size();
  std::vector<Point> starts;
  for (Eigen::Index first = 0; first + 2 < count; ++first) {
    double most = -std::numeric_limits<double>::infinity();  // that the elements take from the squares
    Point nearest(element_dimension);
    for (Eigen::Index second = first + 1; second + 1 < count; ++second) {
      for (Eigen::Index third = second + 1; third < count; ++third) {
        const std::array<Eigen::Index, slipping_elements + 1> chosen{first, second, third, count};
        const Eigen::MatrixXd strains = path.strains(chosen, chosen);
        const Eigen::VectorXd torque = path.torque(chosen);
        const Eigen::VectorXd free = numerics::solve_positive_definite(strains, torque);
        const Eigen::VectorXd stiffness = free.cwiseMax(faint * free.maxCoeff());
        const double explained = stiffness.dot(2.0 * torque - strains * stiffness);
        if (!(explained > most)) continue;
        most = explained;
        nearest << stiffness.array().log(), std::log(travels[first]), std::log(travels[second]),
            std::log(travels[third]), std::log(plant.presliding_damping), std::log(plant.inertia), 0.0;
      }
    }
    if (std::isfinite(most)) starts.push_back(nearest);
  }
  return starts;
}

/// Indices of the elements in the order of the travels at which they slip, the sticking one last.
std::vector<Eigen::Index> in_order_of_slip(const Point& point) {
  std::vector<Eigen::Index> order(slipping_elements + 1);
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end() - 1, [&](Eigen::Index one, Eigen::Index other) {
    return point[element_travel + one] < point[element_travel + other];
  });
  return order;
}

std::string list_lines(const Point& point, double largest_torque) {
  const std::vector<double> levels = levels_at(point, largest_torque);
  const double all = std::accumulate(levels.begin(), levels.end(), 0.0);
  std::vector<std::string> stiffnesses;
  std::vector<std::string> weights;
  for (const friction::GmsElement& element : elements_at(point, levels)) {
    stiffnesses.push_back(fmt::format("{:.6g}", element.stiffness));
    weights.push_back(fmt::format("{:.12g}", element.weight));
  }
  return fmt::format(
      "  breakaway: {:.6g}   # N m, given: the last element sticks throughout\n"
      "  coulomb_ratio: 1.0   # given: records without sliding show one level only\n"
      "  gms:   # fitted values, without distributions\n"
      "    stiffness: [{}]   # N m/rad\n"
      "    weight: [{}]\n"
      "    attraction: {:.3g}   # N m/s, given: the elements slip within milliseconds\n",
      all, fmt::join(stiffnesses, ", "), fmt::join(weights, ", "), attraction_at(largest_torque));
}

}  // namespace

FitModel maxwell_slip_model(const RecordScales& scales, Records records) {
  const double largest_torque = scales.largest_torque;
  FitModel model;
  model.law = friction::FrictionModel::gms;
  model.ranges = law_coordinates(element_dimension);
  model.free.assign(element_dimension, true);
  model.parameters_at = [=](const Point& point) {
    AxisParameters parameters;
    const std::vector<double> levels = levels_at(point, largest_torque);
    parameters.friction.model = friction::FrictionModel::gms;
    parameters.friction.gms_elements = elements_at(point, levels);
    parameters.friction.uniform.breakaway = std::accumulate(levels.begin(), levels.end(), 0.0);
    parameters.friction.uniform.coulomb_ratio = 1.0;
    parameters.friction.uniform.gms_attraction = attraction_at(largest_torque);
    parameters.plant.sliding_damping = std::exp(point[element_damping]);
    parameters.plant.inertia = std::exp(point[element_inertia]);
    return parameters;
  };
  model.quantities_at = [](const Point& point) {
    std::vector<Quantity> quantities;
    const std::vector<Eigen::Index> order = in_order_of_slip(point);
    for (std::size_t i = 0; i <= slipping_elements; ++i) {
      const Eigen::Index at = order[i];
      quantities.push_back(coordinate_quantity(fmt::format("stiffness.{}", i), "", "N m/rad", point, at));
      if (i == slipping_elements) break;
      quantities.push_back(
          coordinate_quantity(fmt::format("slip_travel.{}", i), "", "rad", point, element_travel + at));
    }
    quantities.push_back(coordinate_quantity("sliding_damping", parameter::plant::sliding_damping,
                                             "N m s/rad", point, element_damping));
    quantities.push_back(
        coordinate_quantity("inertia", parameter::plant::inertia, "kg m^2", point, element_inertia));
    quantities.push_back(time_offset_quantity(point));
    return quantities;
  };
  model.starts = nearest_elements(scales, records);
  model.fixed_lines = [=](const Point& point) { return list_lines(point, largest_torque); };
  return model;
}

}  // namespace zerocount::fit

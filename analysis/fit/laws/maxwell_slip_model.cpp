#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/fit/laws/law_identification.hpp"
#include "analysis/fit/presliding/contact.hpp"

namespace zerocount::fit {

namespace {

/// Elements that slip, in the order of the travel at which they do, and one more that sticks throughout.
constexpr std::size_t slipping_elements = 3;

/// Coordinates: the stiffness of all elements (ln κ, of N m/rad); the travel at which the slipping ones slip
/// (ln of rad); damping (ln cs, of N m s/rad); inertia (ln J, of kg m²); time offset (samples).
constexpr Eigen::Index element_travel = slipping_elements + 1;
constexpr Eigen::Index element_damping = element_travel + slipping_elements;
constexpr Eigen::Index element_inertia = element_damping + 1;
constexpr Eigen::Index element_dimension = element_inertia + 2;

/// Level of the sticking element over the largest torque of the records, which it never reaches.
constexpr double never_reached = 10.0;

/// C of the slipping elements, N m/s. At the paper's torques it is the default of a manifest.
double attraction_at(double largest_torque) {
  constexpr double rate = 200.0;  // 1/s
  return rate * largest_torque;
}

/// The levels W of the elements, N m.
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

/// Torque of a branch of the pre-sliding spring after the travel u from the virgin state, N m.
double virgin_torque(const friction::FrictionParameters& contact, double u) {
  return contact.k1 * u - contact.k2 / contact.beta * std::expm1(-contact.beta * u);
}

/// Torque of the elements after the travel u from the virgin state, N m.
double virgin_torque(const Point& point, double u) {
  double torque = std::exp(point[slipping_elements]) * u;
  for (Eigen::Index i = 0; i < element_travel - 1; ++i) {
    torque += std::exp(point[i]) * std::min(u, std::exp(point[element_travel + i]));
  }
  return torque;
}

/// Stiffness of an element where the curve has no corner, as a part of the sticking one's: almost none, or
/// enough for a slope of the sum of squares.
constexpr double faint = 1e-3;
constexpr double visible = 0.2;

using Corners = std::array<double, slipping_elements>;

/// Elements whose virgin curve is a polygon through `virgin` (N m over rad), with corners at rising travels
/// (rad) and the slope `last` beyond them (N m/rad). Sets their coordinates.
/// @param least stiffness of an element, as a part of `last`
template <class Curve>
void set_polygon(const Curve& virgin, const Corners& corners, double last, double least, Point& point) {
  std::array<double, slipping_elements + 1> slope{};
  double u = 0.0;
  for (std::size_t i = 0; i < slipping_elements; ++i) {
    slope[i] = (virgin(corners[i]) - virgin(u)) / (corners[i] - u);
    u = corners[i];
    point[element_travel + static_cast<Eigen::Index>(i)] = std::log(u);
  }
  slope.back() = last;
  for (std::size_t i = 0; i < slipping_elements; ++i) {
    point[static_cast<Eigen::Index>(i)] = std::log(std::max(slope[i] - slope[i + 1], least * last));
  }
  point[slipping_elements] = std::log(last);
}

/// Points with nearly the same virgin curve and one corner elsewhere. The sum of squares has a local minimum
/// for each assignment of the elements to the corners of the records' loops.
std::vector<Point> with_other_corners(const Point& point) {
  std::vector<Point> others;
  for (std::size_t moved = 0; moved < slipping_elements; ++moved) {
    for (const double factor : {0.15, 0.4, 2.5, 6.0}) {
      Corners corners{};
      for (std::size_t i = 0; i < slipping_elements; ++i) {
        corners[i] = std::exp(point[element_travel + static_cast<Eigen::Index>(i)]);
      }
      corners[moved] *= factor;
      std::sort(corners.begin(), corners.end());
      for (const double least : {faint, visible}) {
        others.push_back(point);
        set_polygon([&](double u) { return virgin_torque(point, u); }, corners,
                    std::exp(point[slipping_elements]), least, others.back());
      }
    }
  }
  return others;
}

std::vector<Point> polygons(const RecordScales& scales) {
  const ContactParameters contact = contact_at(scales.contact, scales.creep_torque);
  const double farthest = 0.5 * scales.largest_torque / scales.secant_stiffness;  // travel, rad
  std::vector<Point> starts;
  for (const double last : {0.1, 0.3, 0.6, 0.9}) {
    for (const double ratio : {2.0, 4.0, 8.0}) {
      const double corner = last * farthest;
      Point start = Point::Zero(element_dimension);
      set_polygon([&](double u) { return virgin_torque(contact.friction, u); },
                  {corner / (ratio * ratio), corner / ratio, corner}, contact.friction.k1, faint, start);
      start[element_damping] = std::log(contact.plant.presliding_damping);
      start[element_inertia] = std::log(contact.plant.inertia);
      starts.push_back(start);
    }
  }
  return starts;
}

/// The elements in the order of the travels at which they slip, the sticking one last.
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

FitModel maxwell_slip_model(const RecordScales& scales) {
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
    quantities.push_back(
        coordinate_quantity("sliding_damping", "plant.sliding_damping", "N m s/rad", point, element_damping));
    quantities.push_back(coordinate_quantity("inertia", "plant.inertia", "kg m^2", point, element_inertia));
    quantities.push_back(time_offset_quantity(point));
    return quantities;
  };
  model.starts = polygons(scales);
  model.neighbours = with_other_corners;
  model.fixed_lines = [=](const Point& point) { return list_lines(point, largest_torque); };
  return model;
}

}  // namespace zerocount::fit

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "analysis/record/sliding_identification/unexplained_force.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr std::size_t min_strokes = 2;
constexpr int classes = 10;

struct Sum {
  double torque{0.0};
  double windows{0.0};
};

/// The torque of a window that the law leaves unexplained, its stroke (motion in one direction), and the
/// quantities on which the torque may depend.
struct Residual {
  double torque;
  std::pair<const SlidingRecord*, std::size_t> stroke;
  double direction;
  double position;
  double speed;
  double acceleration;
};

std::vector<Residual> residuals_of(const SlidingFit& fit) {
  std::vector<Residual> residuals;
  for (std::size_t i = 0; i < fit.windows.size(); ++i) {
    const SlidingRecord& record = *fit.windows[i].record;
    const Window& window = *fit.windows[i].window;
    const double time = record.time[window.last] - record.time[window.first];
    residuals.push_back({fit.unexplained[i],
                         {&record, window.stroke},
                         window.direction,
                         0.5 * (record.position[window.first] + record.position[window.last]),
                         std::abs(record.position[window.last] - record.position[window.first]) / time,
                         (record.velocity[window.last] - record.velocity[window.first]) / time});
  }
  return residuals;
}

using WindowQuantity = std::function<double(const Residual&)>;

/// [residual] Index of the class: one of ten equal parts of the quantity's range. If `by_direction` is true,
/// the two directions of motion have separate classes.
std::vector<int> classes_of(const std::vector<Residual>& residuals, const WindowQuantity& quantity,
                            bool by_direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Residual& one : residuals) {
    low = std::min(low, quantity(one));
    high = std::max(high, quantity(one));
  }
  std::vector<int> found;
  for (const Residual& one : residuals) {
    const double part = high > low ? (quantity(one) - low) / (high - low) : 0.0;
    const int number = std::min(static_cast<int>(part * classes), classes - 1);
    found.push_back(by_direction && one.direction < 0.0 ? number + classes : number);
  }
  return found;
}

RepeatingForce repeats_with(std::string name, const std::vector<Residual>& residuals,
                            const std::vector<int>& of_class) {
  std::map<int, Sum> by_class;
  std::map<std::pair<const SlidingRecord*, std::size_t>, Sum> by_stroke;
  std::map<std::pair<int, std::pair<const SlidingRecord*, std::size_t>>, Sum> by_both;
  Sum all;
  const auto add = [](Sum& sum, double torque) {
    sum.torque += torque;
    sum.windows += 1.0;
  };
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Residual& one = residuals[i];
    add(all, one.torque);
    add(by_class[of_class[i]], one.torque);
    add(by_stroke[one.stroke], one.torque);
    add(by_both[{of_class[i], one.stroke}], one.torque);
  }
  RepeatingForce force{.with = std::move(name)};
  force.low = std::numeric_limits<double>::infinity();
  force.high = -force.low;
  double unexplained = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Residual& one = residuals[i];
    const Sum& stroke = by_stroke[one.stroke];
    const Sum& own = by_both[{of_class[i], one.stroke}];
    const Sum& whole = by_class[of_class[i]];
    const double mean = (all.torque - stroke.torque) / (all.windows - stroke.windows);
    double predicted = mean;
    if (whole.windows > own.windows) {
      predicted = (whole.torque - own.torque) / (whole.windows - own.windows);
      force.low = std::min(force.low, whole.torque / whole.windows);
      force.high = std::max(force.high, whole.torque / whole.windows);
    }
    unexplained += (one.torque - predicted) * (one.torque - predicted);
    total += (one.torque - mean) * (one.torque - mean);
  }
  if (force.low > force.high) force.low = force.high = std::numeric_limits<double>::quiet_NaN();
  force.predicted = total > 0.0 ? 1.0 - unexplained / total : 0.0;
  return force;
}

}  // namespace

std::vector<RepeatingForce> repeating_forces(const SlidingFit& fit) {
  const std::vector<Residual> residuals = residuals_of(fit);
  std::size_t strokes = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    strokes += i == 0 || residuals[i].stroke != residuals[i - 1].stroke ? 1 : 0;
  if (strokes < min_strokes) return {};
  const auto with = [&](const char* name, const WindowQuantity& quantity, bool by_direction) {
    return repeats_with(name, residuals, classes_of(residuals, quantity, by_direction));
  };
  return {with("position", &Residual::position, false),
          with("position and direction", &Residual::position, true),
          with("speed and direction", &Residual::speed, true),
          with("acceleration", &Residual::acceleration, false)};
}

}  // namespace zerocount::sliding_identification

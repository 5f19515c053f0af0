#include "analysis/record/sliding_identification/missing_torque.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/record/sliding_identification/added_column.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

/// The motion between two successive samples, according to the fit.
struct Instant {
  double direction;
  double velocity;
  double speed;          ///< |velocity|, rad/s or m/s.
  double place;          ///< Position, scaled to −1 to 1 over the record.
  double moment;         ///< Time, scaled linearly so that the record lasts from −1 to 1.
  double torque;         ///< Torque u of the drive in this interval, N m or N.
  double torque_before;  ///< Torque u of the drive in the preceding interval, N m or N.
  /// Torque u + u0 + p that the axis carries: drive torque, offset and position-dependent torque, N m or N.
  double carried;
  double net;  ///< Accelerating torque: u − u0 − p minus the friction, N m or N.
};

struct TriedTorque {
  TorqueCause cause;
  const char* name;
  std::function<double(const Instant&)> torque;
};

std::vector<TriedTorque> torques_to_try(double max_speed) {
  using enum TorqueCause;
  std::vector<TriedTorque> tried{
      {lag, "a delay of the torque", [](const Instant& i) { return i.torque - i.torque_before; }},
      {speed, "drag that grows with the square of the speed",
       [](const Instant& i) { return i.velocity * i.speed; }},
      {speed, "drag that grows with the cube of the speed",
       [](const Instant& i) { return i.velocity * i.speed * i.speed; }},
      {direction, "a damping that differs by direction", [](const Instant& i) { return i.speed; }},
      {direction, "drag that grows with the square of the speed and differs by direction",
       [](const Instant& i) { return i.speed * i.speed; }},
      {load, "friction that grows with the load",
       [](const Instant& i) { return i.direction * std::abs(i.carried); }},
      {load, "friction that grows with the square of the load",
       [](const Instant& i) { return i.direction * i.carried * i.carried; }},
      {position, "a torque that depends on the position", [](const Instant& i) { return i.place; }},
      {position, "a torque that depends on the square of the position",
       [](const Instant& i) { return i.place * i.place; }},
      {position, "friction that depends on the position",
       [](const Instant& i) { return i.direction * i.place; }},
      {position, "friction that depends on the square of the position",
       [](const Instant& i) { return i.direction * i.place * i.place; }},
      {position, "damping that depends on the position",
       [](const Instant& i) { return i.velocity * i.place; }},
      {position, "inertia that depends on the position", [](const Instant& i) { return i.net * i.place; }},
      {time, "an offset that drifts", [](const Instant& i) { return i.moment; }},
      {time, "friction that drifts", [](const Instant& i) { return i.direction * i.moment; }},
      {time, "damping that drifts", [](const Instant& i) { return i.velocity * i.moment; }},
      {time, "inertia that drifts", [](const Instant& i) { return i.net * i.moment; }}};
  for (const double divisor : {4.0, 10.0, 30.0})
    tried.push_back({speed, "friction that depends on the speed in another way", [=](const Instant& i) {
                       return i.direction * std::exp(-divisor * i.speed / max_speed);
                     }});
  for (const double half_waves : {1.0, 2.0, 3.0}) {
    const double wave_number = half_waves * std::numbers::pi;
    tried.push_back({position, "a torque that depends on the position",
                     [=](const Instant& i) { return std::sin(wave_number * i.place); }});
    tried.push_back({position, "a torque that depends on the position",
                     [=](const Instant& i) { return std::cos(wave_number * i.place); }});
    tried.push_back({position, "friction that depends on the position",
                     [=](const Instant& i) { return i.direction * std::sin(wave_number * i.place); }});
    tried.push_back({position, "friction that depends on the position",
                     [=](const Instant& i) { return i.direction * std::cos(wave_number * i.place); }});
  }
  return tried;
}

/// Scales a value linearly from [low, high] to [−1, 1].
double scaled_to_range(double value, double low, double high) {
  return high > low ? (2.0 * value - low - high) / (high - low) : 0.0;
}

constexpr std::array<std::string_view, 6> cause_labels{"lag",  "speed",    "direction",
                                                       "load", "position", "time"};

/// Ranges of a record: of its positions (low, high; rad or m) and of its time (start, end; s).
struct Extent {
  double low;
  double high;
  double start;
  double end;
};

double torque_in(const SlidingRecord& record, std::size_t k) {
  return motion::course_after(record.torque[k], 0.5 * (record.time[k + 1] - record.time[k])).now;
}

double position_torque_in(const SlidingRecord& record, const SlidingPoint& point, std::size_t k) {
  double torque = 0.0;
  for (std::size_t j = 0; j < position_terms && record.waves > 0; ++j)
    torque += record.shape_between[k][j] * point[static_cast<Eigen::Index>(position_amplitudes + j)];
  return torque;
}

double friction_at(const SlidingPoint& point, double direction, double speed) {
  const double ratio = speed / std::exp(point[log_stribeck_velocity]);
  return direction * (point[coulomb_level] + point[stribeck_excess] * std::exp(-ratio * ratio) +
                      point[viscous_damping] * speed);
}

/// [interval] Motion between successive samples of a window (a piece of a record simulated from its own
/// initial state).
std::vector<Instant> instants_of(const FittedWindow& fitted, const SlidingPoint& point,
                                 const Eigen::VectorXd& residual, const Extent& extent) {
  const SlidingRecord& record = *fitted.record;
  const Window& window = *fitted.window;
  std::vector<Instant> instants;
  for (std::size_t k = window.first; k < window.last; ++k) {
    const auto i = static_cast<Eigen::Index>(k - window.first);
    const double now = record.position[k] + record.resolution * residual[i];
    const double next = record.position[k + 1] + record.resolution * residual[i + 1];
    Instant one{};
    one.direction = window.direction;
    one.velocity = (next - now) / (record.time[k + 1] - record.time[k]);
    one.speed = std::abs(one.velocity);
    one.place = scaled_to_range(0.5 * (now + next), extent.low, extent.high);
    one.moment = scaled_to_range(record.time[k], extent.start, extent.end);
    one.torque = torque_in(record, k);
    one.torque_before = torque_in(record, k - 1);
    const double other = point[offset_torque] + position_torque_in(record, point, k);
    one.carried = one.torque + other;
    one.net = one.torque - other - friction_at(point, one.direction, one.speed);
    instants.push_back(one);
  }
  return instants;
}

/// Response of the position, in steps of the readings, to torques against the drive that are constant in each
/// interval: J·dω/dt = −f − cs·ω from rest.
Eigen::VectorXd response_to(const std::vector<Instant>& instants, const FittedWindow& fitted,
                            const SlidingPoint& point, const TriedTorque& tried) {
  const SlidingRecord& record = *fitted.record;
  const double inertia = std::exp(point[log_inertia]);
  const double rate = point[viscous_damping] / inertia;
  Eigen::VectorXd response = Eigen::VectorXd::Zero(std::ssize(instants) + 1);
  double velocity = 0.0;
  double position = 0.0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const std::size_t k = fitted.window->first + i;
    const double time = record.time[k + 1] - record.time[k];
    const double kick = -time * tried.torque(instants[i]) / (inertia * record.resolution);
    // The damper by the trapezoidal rule.
    const double before = velocity;
    velocity = ((1.0 - 0.5 * rate * time) * velocity + kick) / (1.0 + 0.5 * rate * time);
    position += 0.5 * time * (before + velocity);
    response[static_cast<Eigen::Index>(i) + 1] = position;
  }
  return response;
}

constexpr double tiny_variance = std::numeric_limits<double>::min();

/// Smallest number of successive samples of a stroke that form a part which is taken as independent of the
/// others. Forces that the law lacks may depend on each other from one short window to the next.
constexpr std::size_t min_block_samples = 64;

/// Matrix with a column for each regressor of a window, each column after regression on the window's initial
/// state: the derivatives with respect to the free parameters, then the responses to the tried torques, then
/// the negative residuals. The sign makes the coefficients of the tried torques compensate for the residuals.
Eigen::MatrixXd columns_of(const FittedWindow& fitted, const SlidingFit& fit, const Extent& extent,
                           std::span<const TriedTorque> tried) {
  const WindowSlopes slopes = slopes_of(fitted, fit.point);
  const std::vector<Instant> instants = instants_of(fitted, fit.point, slopes.residual, extent);
  const Eigen::MatrixXd known = free_slopes(slopes, fit.free);
  const Eigen::Index parameters = known.cols() - 1;
  Eigen::MatrixXd columns(known.rows(), known.cols() + std::ssize(tried));
  columns.leftCols(parameters) = known.leftCols(parameters);
  for (std::size_t j = 0; j < tried.size(); ++j)
    columns.col(parameters + static_cast<Eigen::Index>(j)) =
        response_to(instants, fitted, fit.point, tried[j]);
  columns.col(columns.cols() - 1) = -known.col(parameters);
  return without(slopes.by_start, columns);
}

/// Matrix of the inner products of the columns of columns_of() with each other.
using Products = Eigen::MatrixXd;

/// Adds the products of a window to the last part of the samples, or begins a new part with them.
void add_to(std::vector<Products>& parts, const Products& products, bool new_part) {
  if (new_part)
    parts.push_back(products);
  else
    parts.back() += products;
}

Equations equations_with(const Products& products, Eigen::Index parameters, Eigen::Index tried) {
  std::vector<Eigen::Index> used{parameters + tried};
  for (Eigen::Index j = 0; j < parameters; ++j) used.push_back(j);
  const Eigen::Index last = products.cols() - 1;
  return {products(used, used), products(used, last), products(last, last)};
}

Extent extent_of(const SlidingRecord& record) {
  const auto [low, high] = std::ranges::minmax(record.position);
  return {low, high, record.time.front(), record.time.back()};
}

/// Sums of the inner products of columns_of(): over blocks of successive samples within strokes, and over
/// whole strokes.
struct Parts {
  std::vector<Products> blocks;
  std::vector<Products> strokes;
  Eigen::Index parameters{0};  ///< Number of free parameters of the fit.
  /// Degrees of freedom: number of samples minus the numbers of parameters and initial states.
  double freedom{0.0};
};

Parts parts_of(const SlidingFit& fit, std::span<const TriedTorque> tried) {
  Parts parts;
  parts.parameters = std::count(fit.free.begin(), fit.free.end(), true);
  parts.freedom = static_cast<double>(fit.samples) - 2.0 * static_cast<double>(fit.windows.size()) -
                  static_cast<double>(parts.parameters) - 1.0;
  const SlidingRecord* record = nullptr;
  Extent extent{};
  std::size_t stroke = 0;
  std::size_t block_samples = 0;
  for (const FittedWindow& fitted : fit.windows) {
    const bool new_record = fitted.record != record;
    if (new_record) extent = extent_of(*fitted.record);
    record = fitted.record;
    const bool new_stroke = new_record || fitted.window->stroke != stroke;
    stroke = fitted.window->stroke;
    const bool new_block = new_stroke || block_samples >= min_block_samples;
    block_samples = (new_block ? 0 : block_samples) + samples_of(*fitted.window);
    const Eigen::MatrixXd columns = columns_of(fitted, fit, extent, tried);
    const Products products = numerics::transposed_product(columns, columns);
    add_to(parts.blocks, products, new_block);
    add_to(parts.strokes, products, new_stroke);
  }
  return parts;
}

AddedColumn column_of(const std::vector<Products>& parts, const Parts& all, std::size_t tried) {
  std::vector<Equations> equations;
  for (const Products& part : parts)
    equations.push_back(equations_with(part, all.parameters, static_cast<Eigen::Index>(tried)));
  return added_column(equations, all.freedom);
}

/// Degrees of freedom of the jackknife's standard error, at least 10. With fewer, this error alone would
/// never show significance; the standard error from the residuals' autocorrelation is used beside it.
double freedom_of(const AddedColumn& column) {
  constexpr double least = 10.0;
  return std::max(least, column.clusters - 1.0);
}

/// Largest change of a free parameter when the column is added, in standard errors of this parameter.
double shift_in_errors(const AddedColumn& column, const SlidingFit& fit) {
  double largest = 0.0;
  Eigen::Index place = 0;
  for (Eigen::Index i = 0; i < fit.point.size(); ++i) {
    if (!fit.free[static_cast<std::size_t>(i)]) continue;
    const double error = std::sqrt(std::max(fit.covariance(i, i), tiny_variance));
    largest = std::max(largest, std::abs(column.shift[place++]) / error);
  }
  return largest;
}

/// Sum of the products of elements of `values` whose indices differ by `lag`.
double products_apart(const Eigen::VectorXd& values, Eigen::Index lag) {
  const Eigen::Index count = values.size() - lag;
  return count > 0 ? values.head(count).dot(values.tail(count)) : 0.0;
}

/// Factor on the variance of a coefficient because the residuals of a window depend on each other, relative
/// to independent residuals: 1 + 2·Σ r(l)·c(l)·(1 − l/L), with the autocorrelations r of the residuals and c
/// of the column, both without what the other terms explain of them, and L the samples of the longest window
/// (Newey and West, Econometrica 55 (1987) 703). At least 1.
double variance_factor(const SlidingFit& fit, const TriedTorque& tried, const AddedColumn& column,
                       const Parts& parts, std::size_t number) {
  const Eigen::Index free = parts.parameters;
  const auto place = free + static_cast<Eigen::Index>(number);
  Products total = parts.strokes.front();
  for (std::size_t i = 1; i < parts.strokes.size(); ++i) total += parts.strokes[i];
  const Eigen::VectorXd scale =
      total.diagonal().head(free).cwiseMax(tiny_variance).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd information =
      scale.asDiagonal() * total.topLeftCorner(free, free) * scale.asDiagonal();
  const Eigen::VectorXd by_others = scale.cwiseProduct(
      numerics::least_squares(information, scale.cwiseProduct(total.col(place).head(free))).col(0));
  std::size_t longest = 0;
  for (const FittedWindow& fitted : fit.windows) longest = std::max(longest, samples_of(*fitted.window));
  std::vector<double> of_residuals(longest, 0.0);
  std::vector<double> of_column(longest, 0.0);
  std::vector<double> pairs(longest, 0.0);
  for (const FittedWindow& fitted : fit.windows) {
    const Eigen::MatrixXd columns = columns_of(fitted, fit, extent_of(*fitted.record), {&tried, 1});
    const Eigen::VectorXd alone = columns.col(free) - columns.leftCols(free) * by_others;
    const Eigen::VectorXd residual = columns.col(free + 1) - column.coefficient * columns.col(free) -
                                     columns.leftCols(free) * column.shift;
    for (std::size_t lag = 0; lag < samples_of(*fitted.window); ++lag) {
      of_residuals[lag] += products_apart(residual, static_cast<Eigen::Index>(lag));
      of_column[lag] += products_apart(alone, static_cast<Eigen::Index>(lag));
      pairs[lag] += static_cast<double>(samples_of(*fitted.window) - lag);
    }
  }
  double factor = 1.0;
  for (std::size_t lag = 1; lag < longest; ++lag) {
    const double of_residual =
        of_residuals[lag] / pairs[lag] * pairs[0] / std::max(of_residuals[0], tiny_variance);
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(longest);
    factor += 2.0 * weight * of_residual * of_column[lag] / std::max(of_column[0], tiny_variance);
  }
  return std::max(1.0, factor);
}

/// Mean squares of torques over all strokes, (N m)².
struct MeanSquares {
  double drive{0.0};          ///< Mean square of the drive torque u, (N m)² or N².
  std::vector<double> tried;  ///< [tried torque] Mean square with the coefficient 1.
};

MeanSquares mean_squares(const SlidingFit& fit, std::span<const TriedTorque> tried) {
  MeanSquares means{.tried = std::vector<double>(tried.size(), 0.0)};
  double count = 0.0;
  for (const FittedWindow& fitted : fit.windows) {
    const WindowSlopes slopes = slopes_of(fitted, fit.point);
    for (const Instant& one : instants_of(fitted, fit.point, slopes.residual, extent_of(*fitted.record))) {
      ++count;
      means.drive += one.torque * one.torque;
      for (std::size_t j = 0; j < tried.size(); ++j) {
        const double torque = tried[j].torque(one);
        means.tried[j] += torque * torque;
      }
    }
  }
  means.drive /= std::max(count, 1.0);
  for (double& one : means.tried) one /= std::max(count, 1.0);
  return means;
}

/// Smallest relevant torque as a proportion of the drive's torque. A smaller one changes no estimate by more
/// than about this proportion. Records without noise show such torques because of rounding.
constexpr double negligible_torque = 1e-4;

}  // namespace

std::string_view to_string(TorqueCause cause) {
  return cause_labels.at(static_cast<std::size_t>(cause));
}

std::vector<std::string> cause_words() {
  return {cause_labels.begin(), cause_labels.end()};
}

std::vector<MissingTorque> tried_torques(const SlidingFit& fit) {
  double max_speed = 0.0;
  for (const FittedWindow& fitted : fit.windows) max_speed = std::max(max_speed, fitted.record->max_velocity);
  const std::vector<TriedTorque> tried = torques_to_try(max_speed);
  const Parts parts = parts_of(fit, tried);
  const MeanSquares sizes = mean_squares(fit, tried);
  const double chance = 1e-3 / static_cast<double>(tried.size());
  std::vector<MissingTorque> found;
  for (std::size_t j = 0; j < tried.size(); ++j) {
    const AddedColumn column = column_of(parts.blocks, parts, j);
    MissingTorque one{.cause = tried[j].cause,
                      .name = tried[j].name,
                      .coefficient = column.coefficient,
                      .visibility = ratio_to_chance(column, chance, freedom_of(column)),
                      .explained = column.explained,
                      .shift = shift_in_errors(column, fit)};
    const double limit = statistics::student_t_quantile(std::max(1.0, parts.freedom), 1.0 - 0.5 * chance);
    const auto narrow = [&](double visibility) { one.visibility = std::min(one.visibility, visibility); };
    narrow(std::sqrt(column.gain / std::max(column.white, tiny_variance)) / limit);
    if (parts.strokes.size() >= min_independent_strokes) {
      const AddedColumn by_stroke = column_of(parts.strokes, parts, j);
      narrow(ratio_to_chance(by_stroke, chance, freedom_of(by_stroke)));
    }
    if (one.visibility >= 1.0)
      narrow(std::sqrt(column.gain / (column.white * variance_factor(fit, tried[j], column, parts, j))) /
             limit);
    if (std::abs(column.coefficient) * std::sqrt(sizes.tried[j]) < negligible_torque * std::sqrt(sizes.drive))
      one.visibility = 0.0;
    found.push_back(std::move(one));
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &MissingTorque::visibility);
  return found;
}

}  // namespace zerocount::sliding_identification

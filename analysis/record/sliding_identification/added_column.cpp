#include "analysis/record/sliding_identification/added_column.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/basis/statistics/distributions.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr double no_scale = std::numeric_limits<double>::min();

}  // namespace

void Equations::operator+=(const Equations& other) {
  information += other.information;
  right += other.right;
  squares += other.squares;
}

AddedColumn added_column(std::span<const Equations> parts, double freedom) {
  Equations total = parts.front();
  for (const Equations& part : parts.subspan(1)) total += part;
  const Eigen::VectorXd scale = total.information.diagonal().cwiseMax(no_scale).cwiseSqrt().cwiseInverse();
  const auto scaled = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
    return scale.asDiagonal() * matrix * scale.asDiagonal();
  };
  const Eigen::MatrixXd inverse = numerics::pseudo_inverse(scaled(total.information));
  const Eigen::VectorXd found = inverse * scale.cwiseProduct(total.right);
  const double own = std::max(inverse(0, 0), no_scale);
  double jackknife = 0.0;
  double information = 0.0;
  double squared = 0.0;
  for (const Equations& part : parts) {
    const Eigen::MatrixXd of_part = scaled(part.information);
    const Eigen::VectorXd score = scale.cwiseProduct(part.right) - of_part * found;
    const double change = numerics::least_squares(scaled(total.information) - of_part, score)(0, 0);
    jackknife += change * change;
    const double on_coefficient = inverse.col(0).dot(of_part * inverse.col(0));
    information += on_coefficient;
    squared += on_coefficient * on_coefficient;
  }
  AddedColumn column;
  const double squares = total.squares - found.dot(scale.cwiseProduct(total.right));
  column.coefficient = scale[0] * found[0];
  column.gain = found[0] * found[0] / own;
  column.explained = column.gain / std::max(squares + column.gain, no_scale);
  column.white = squares / std::max(freedom, 1.0);
  column.clustered = jackknife / own;
  column.clusters = information * information / std::max(squared, no_scale);
  column.shift = scale.tail(scale.size() - 1).cwiseProduct(found.tail(found.size() - 1));
  return column;
}

double ratio_to_chance(const AddedColumn& column, double chance, double freedom) {
  const double limit = statistics::student_t_quantile(freedom, 1.0 - 0.5 * chance);
  return std::sqrt(column.gain / std::max(column.clustered, no_scale)) / limit;
}

Eigen::MatrixXd without(const Eigen::MatrixXd& others, const Eigen::MatrixXd& columns) {
  return columns - numerics::product(others, numerics::least_squares(others, columns));
}

Eigen::MatrixXd free_slopes(const WindowSlopes& slopes, const FreeParameters& free) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index j = 0; j < slopes.by_point.cols(); ++j)
    if (free[static_cast<std::size_t>(j)]) columns.push_back(j);
  Eigen::MatrixXd known(slopes.residual.size(), std::ssize(columns) + 1);
  known << slopes.by_point(Eigen::all, columns), slopes.residual;
  return known;
}

}  // namespace zerocount::sliding_identification

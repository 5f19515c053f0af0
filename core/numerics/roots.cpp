#include "core/numerics/roots.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <boost/math/tools/minima.hpp>

#include "core/numerics/power_series.hpp"

namespace zerocount::numerics {

namespace {

constexpr std::size_t max_coefficients = 16;
constexpr int deepest_subdivision = 40;

/// A polynomial over [low, high] by its Bernstein coefficients: it lies in their convex hull.
struct BernsteinPiece {
  std::array<double, max_coefficients> coefficients{};
  std::size_t count{0};
  double low{0.0};
  double high{0.0};
};

/// Bernstein coefficients over [0, end] of the polynomial with the power coefficients c: b_i = Σ_{j≤i}
/// [C(i,j)/C(n,j)]·c_j·endʲ. Computed in place: with a_j = c_j·endʲ/C(n,j), n rounds of adding each entry to
/// its successor give b_i = Σ_j C(i,j)·a_j.
BernsteinPiece bernstein_over(std::span<const double> c, double end) {
  BernsteinPiece piece{{}, c.size(), 0.0, end};
  const std::size_t n = c.size() - 1;
  double scale = 1.0;
  for (std::size_t j = 0; j <= n; ++j) {
    piece.coefficients[j] = c[j] * scale;
    scale *= end * static_cast<double>(j + 1) /
             static_cast<double>(n - j);  // 1/C(n,j+1) from 1/C(n,j); unused at j = n
  }
  for (std::size_t round = 0; round < n; ++round) {
    for (std::size_t i = n; i > round; --i) piece.coefficients[i] += piece.coefficients[i - 1];
  }
  return piece;
}

/// The two halves of a polynomial piece in Bernstein form, by de Casteljau's subdivision at the middle.
std::array<BernsteinPiece, 2> halves(const BernsteinPiece& piece) {
  const double middle = 0.5 * (piece.low + piece.high);
  BernsteinPiece left{{}, piece.count, piece.low, middle};
  BernsteinPiece right{piece.coefficients, piece.count, middle, piece.high};
  for (std::size_t i = 0; i < piece.count; ++i) {
    left.coefficients[i] = right.coefficients[0];
    for (std::size_t j = 0; j + 1 < piece.count - i; ++j) {
      right.coefficients[j] = 0.5 * (right.coefficients[j] + right.coefficients[j + 1]);
    }
  }
  return {left, right};
}

int sign_variations(const BernsteinPiece& piece) {
  int variations = 0;
  double last = piece.coefficients[0];
  for (std::size_t i = 1; i < piece.count; ++i) {
    const double here = piece.coefficients[i];
    if (here == 0.0) continue;
    if ((last < 0.0) != (here < 0.0)) ++variations;
    last = here;
  }
  return variations;
}

std::optional<double> first_in(const BernsteinPiece& piece, std::span<const double> c, double sign,
                               int depth) {
  const int variations = sign_variations(piece);
  const double at_high = piece.coefficients[piece.count - 1];
  if (variations == 0) return at_high == 0.0 ? std::optional(piece.high) : std::nullopt;
  if (variations == 1 && at_high * sign < 0.0) return bracketed_root(c, piece.low, piece.high);
  if (depth == deepest_subdivision) {
    return at_high * sign <= 0.0 ? std::optional(piece.high) : std::nullopt;
  }
  const auto [left, right] = halves(piece);
  if (std::optional<double> root = first_in(left, c, sign, depth + 1)) return root;
  return first_in(right, c, sign, depth + 1);
}

}  // namespace

double bracketed_root(std::span<const double> c, double low, double high) {
  const bool rising =
      value_at(c, low) < 0.0;  // at the low end, because the root may lie exactly at the high one
  double t = 0.5 * (low + high);
  double last_width = high - low;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t k = c.size(); k-- > 0;) {
      slope = slope * t + value;
      value = value * t + c[k];
    }
    if (value == 0.0) return t;
    ((value > 0.0) == rising ? high : low) = t;
    double next = t - value / slope;
    // Newton's step if it stays inside the bracket and shrinks, else bisection.
    if (!(next > low && next < high) || std::abs(next - t) > 0.5 * last_width) next = 0.5 * (low + high);
    last_width = std::abs(next - t);
    if (last_width <= 1e-16 * high || next == t) return next;
    t = next;
  }
  return t;
}

std::optional<double> first_sign_change(std::span<const double> coefficients, double end) {
  if (std::abs(coefficients[0]) > excursion_bound(coefficients, end)) return std::nullopt;
  return first_in(bernstein_over(coefficients, end), coefficients, coefficients[0], 0);
}

std::pair<double, double> minimum_between(double low, double high, int bits,
                                          const std::function<double(double)>& f) {
  return boost::math::tools::brent_find_minima(f, low, high, bits);
}

}  // namespace zerocount::numerics

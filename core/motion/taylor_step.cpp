#include "core/motion/taylor_step.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/roots.hpp"

namespace zerocount::motion {
namespace {

constexpr double max_exponent_growth = 6.0;
constexpr double negligible_exponent = -40.0;  // exp(−40) = 4e-18

}  // namespace

double step_within(const numerics::Series& position, const numerics::Series& velocity,
                   const numerics::Series& exponent, double tolerance, double longest) {
  const auto last_terms = [&](double t) {
    double before_last = 1.0;  // t to the power of series_order − 1
    for (std::size_t k = 1; k < numerics::series_order; ++k) before_last *= t;
    return before_last * ((std::abs(position[numerics::series_order - 1]) +
                           t * std::abs(velocity[numerics::series_order - 1])) +
                          t * (std::abs(position[numerics::series_order]) +
                               t * std::abs(velocity[numerics::series_order])));
  };
  double t = longest;
  for (;;) {
    const double excess = last_terms(t) / (tolerance * t / longest);
    if (!(excess > 1.0) || t == 0.0) break;
    t *= std::clamp(0.9 * numerics::pow(excess, -1.0 / static_cast<double>(numerics::series_order)), 0.01,
                    0.9);
  }
  const double highest = std::max(exponent[0] + max_exponent_growth, negligible_exponent);
  while (exponent[0] + numerics::growth_bound(exponent, t) > highest && t > 0.0) t *= 0.7;
  return t;
}

std::optional<double> next_sign_change(std::span<const double> series, double end) {
  while (!series.empty() && series.front() == 0.0) series = series.subspan(1);
  if (series.empty()) return std::nullopt;
  return numerics::first_sign_change(series, end);
}

}  // namespace zerocount::motion

#include "analysis/monitor/change_martingale.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::size_t sizes_of_change = 6;
constexpr double largest_change = 2.0;          // size of a bet at its stake
constexpr double smallest_change = 1.0 / 32.0;  // below all sizes at a stake
/// The first kind of bets has no step.
constexpr std::array steps{0.0, 1.0 / 64, 1.0 / 32, 1.0 / 16,  1.0 / 8,   1.0 / 4,
                           0.5, 3.0 / 4,  7.0 / 8,  15.0 / 16, 31.0 / 32, 63.0 / 64};
constexpr double max_loss = 0.9;       // of a bet by a step
constexpr double max_capital = 1e200;  // the most that a bet can have, so that sums stay finite

/// 1/log2(t + 1), of which the differences are the stakes: they sum to 1.
double kept_before(std::int64_t t) {
  return numerics::log(2.0) / numerics::log(static_cast<double>(t) + 1.0);
}

/// log2 of the largest bet at the value that follows so many.
int highest_exponent(std::int64_t before) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(before)));
}

/// The part of a stake in each direction that is bet in this way.
double weight_of(std::size_t kind) {
  return 0.5 * (kind == 0 ? 0.5 : 0.5 / static_cast<double>(steps.size() - 1));
}

/// A value that is as likely as not below the step q, as bets take it: of mean 0 and variance 1.
double score(double p, double q) {
  return p < q ? std::sqrt((1.0 - q) / q) : -std::sqrt(q / (1.0 - q));
}

double limited_size(double size, double q) {
  return std::min(size, max_loss * std::sqrt((1.0 - q) / q));
}

/// p of a bet in the direction.
double towards(Direction direction, double p) {
  return direction == Direction::higher ? p : 1.0 - p;
}

double log_gain(std::size_t kind, Direction direction, double p, double size) {
  if (kind > 0)
    return numerics::log(1.0 + limited_size(size, steps[kind]) * score(towards(direction, p), steps[kind]));
  const double z = -numerics::normal_quantile(p);
  return (direction == Direction::higher ? size * z : -size * z) - 0.5 * size * size;
}

}  // namespace

ChangeMartingale::ChangeMartingale(std::int64_t baseline)
    : baseline_(baseline),
      lowest_(highest_exponent(baseline) + 1 - static_cast<int>(sizes_of_change)),
      sizes_(sizes_of_change) {}

void ChangeMartingale::update(double p) {
  ++values_;
  const std::int64_t before = baseline_ + values_ - 1;
  sizes_ = static_cast<std::size_t>(highest_exponent(before) + 1 - lowest_);
  const double stake =
      (kept_before(values_) - kept_before(values_ + 1)) / static_cast<double>(sizes_of_change);
  Capitals size;  // NOLINT(cppcoreguidelines-pro-type-member-init): those in use are set
  Capitals up;    // NOLINT(cppcoreguidelines-pro-type-member-init)
  Capitals down;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const double z = -numerics::normal_quantile(p);
  for (std::size_t i = 0; i < sizes_; ++i) {
    size[i] = std::ldexp(1.0, lowest_ + static_cast<int>(i)) / static_cast<double>(before);
    const double toll = numerics::exp(-0.5 * size[i] * size[i]);
    const double gain = numerics::exp(size[i] * z);
    up[i] = gain * toll;
    down[i] = toll / gain;
  }
  const std::size_t first_staked = sizes_ - sizes_of_change;
  for (std::size_t d = 0; d < capitals_.size(); ++d) {
    const double one_sided = towards(static_cast<Direction>(d), p);
    for (std::size_t kind = 0; kind < kinds; ++kind) {
      Capitals& capital = capitals_[d][kind];
      for (std::size_t i = first_staked; i < sizes_; ++i) capital[i] += stake * weight_of(kind);
      if (kind == 0) {
        const Capitals& gain = d == 0 ? up : down;
        for (std::size_t i = 0; i < sizes_; ++i) capital[i] = std::min(max_capital, capital[i] * gain[i]);
        continue;
      }
      const double y = score(one_sided, steps[kind]);
      const double limit = limited_size(max_capital, steps[kind]);
      for (std::size_t i = 0; i < sizes_; ++i)
        capital[i] = std::min(max_capital, capital[i] * (1.0 + std::min(size[i], limit) * y));
    }
  }
}

double ChangeMartingale::capital() const {
  double sum = kept_before(values_ + 1);
  for (const auto& direction : capitals_)
    for (const Capitals& capital : direction)
      sum += std::accumulate(capital.begin(), capital.begin() + static_cast<std::ptrdiff_t>(sizes_), 0.0);
  return sum;
}

Direction ChangeMartingale::direction() const {
  std::array<double, 2> sums{};
  for (std::size_t d = 0; d < capitals_.size(); ++d)
    for (const Capitals& capital : capitals_[d])
      sums[d] += std::accumulate(capital.begin(), capital.begin() + static_cast<std::ptrdiff_t>(sizes_), 0.0);
  return sums[0] >= sums[1] ? Direction::higher : Direction::lower;
}

std::int64_t ChangeMartingale::since(std::span<const double> p) const {
  const Direction toward = direction();
  const auto& capitals = capitals_[static_cast<std::size_t>(toward)];
  std::size_t best_kind = 0;
  std::size_t best_size = 0;
  for (std::size_t kind = 0; kind < kinds; ++kind)
    for (std::size_t i = 0; i < sizes_; ++i)
      if (capitals[kind][i] > capitals[best_kind][best_size]) {
        best_kind = kind;
        best_size = i;
      }
  const double most = std::ldexp(1.0, lowest_ + static_cast<int>(best_size));
  double sum = 0.0;
  double best = -HUGE_VAL;
  std::int64_t first = 1;
  for (std::int64_t t = std::ssize(p); t >= 1; --t) {
    const double size = most / static_cast<double>(baseline_ + t - 1);
    if (size > largest_change) break;  // no stake before was on this bet
    sum += log_gain(best_kind, toward, p[static_cast<std::size_t>(t - 1)], size);
    if (sum > best && size > smallest_change) {
      best = sum;
      first = t;
    }
  }
  return first;
}

}  // namespace zerocount::monitor

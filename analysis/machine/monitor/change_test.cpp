#include "analysis/machine/monitor/change_test.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::monitor {
namespace {

constexpr std::size_t sizes_of_change = 6;
constexpr double largest_change = 2.0;          // size of a bet at its stake
constexpr double smallest_change = 1.0 / 32.0;  // below all sizes at a stake
/// [kind of bet] Proportion q of p-values below which a bet on a step pays. Kind 0 bets on normal scores, so
/// its 0 is not used.
constexpr std::array steps{0.0, 1.0 / 64, 1.0 / 32, 1.0 / 16,  1.0 / 8,   1.0 / 4,
                           0.5, 3.0 / 4,  7.0 / 8,  15.0 / 16, 31.0 / 32, 63.0 / 64};
constexpr double max_loss = 0.9;       // of a bet by a step
constexpr double max_capital = 1e200;  // the most that a bet can have, so that sums stay finite

/// Proportion r_{t−1} = 1/log2(t + 1) of the initial capital that is not yet staked before value number t,
/// from 1. The decreases of this proportion are the stakes of new bets; all together they sum to 1.
double kept_before(std::int64_t t) {
  return numerics::log(2.0) / numerics::log(static_cast<double>(t) + 1.0);
}

/// The largest integer k with 2^k/before ≤ 2: binary logarithm of the size of the largest bet, before
/// division by the number `before` of all values (baseline included) that precede the current one.
int highest_exponent(std::int64_t before) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(before)));
}

/// Proportion of each stake that is bet on one direction (higher or lower values) with the kind `kind`: 0 for
/// normal scores, otherwise a step. Over all kinds and both directions it sums to 1.
double weight_of(std::size_t kind) {
  return 0.5 * (kind == 0 ? 0.5 : 0.5 / static_cast<double>(steps.size() - 1));
}

/// Score of a p-value for a bet that at least the expected proportion q of p-values lies below q: positive if
/// p < q, negative otherwise. For uniform p it has mean 0 and variance 1.
double score(double p, double q) {
  return p < q ? std::sqrt((1.0 - q) / q) : -std::sqrt(q / (1.0 - q));
}

double limited_size(double size, double q) {
  return std::min(size, max_loss * std::sqrt((1.0 - q) / q));
}

/// The p-value for a bet in the direction: p for higher values, 1 − p for lower ones, so that a small result
/// always supports the bet.
double towards(Direction direction, double p) {
  return direction == Direction::higher ? p : 1.0 - p;
}

double log_gain(std::size_t kind, Direction direction, double p, double size) {
  if (kind > 0)
    return numerics::log(1.0 + limited_size(size, steps[kind]) * score(towards(direction, p), steps[kind]));
  const double z = -numerics::normal_quantile(p);
  return (direction == Direction::higher ? size * z : -size * z) - 0.5 * size * size;
}

std::vector<RankedBag> bags_of(std::vector<std::vector<double>> baseline) {
  std::vector<RankedBag> bags;
  for (std::vector<double>& values : baseline) bags.emplace_back(std::move(values));
  return bags;
}

std::int64_t size_of(const std::vector<RankedBag>& bags) {
  std::int64_t size = 0;
  for (const RankedBag& bag : bags) size += bag.size();
  return size;
}

constexpr std::size_t min_values = 8;
constexpr std::size_t max_values = 100'000;
constexpr std::size_t max_orders = 999;
constexpr std::size_t min_orders = 199;
constexpr std::size_t max_work = 20'000'000;  // values times orders times windows, beyond min_orders

std::vector<std::vector<std::size_t>> places_of(std::span<const std::size_t> classes) {
  std::vector<std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] >= places.size()) places.resize(classes[i] + 1);
    places[classes[i]].push_back(i);
  }
  return places;
}

/// Appends to `sums_of_squares`, for each window length b, the sum over all runs of b consecutive values of
/// (sum of the run)².
void add_windows(const std::vector<double>& x, std::span<const std::size_t> windows,
                 std::vector<double>& sums_of_squares) {
  std::vector<double> sums(x.size() + 1, 0.0);
  std::partial_sum(x.begin(), x.end(), sums.begin() + 1);
  for (const std::size_t window : windows) {
    double total = 0.0;
    for (std::size_t i = window; i < sums.size(); ++i) {
      const double sum = sums[i] - sums[i - window];
      total += sum * sum;
    }
    sums_of_squares.push_back(total);
  }
}

/// Result of dependence_of() from its statistics T_b (sums of squared window sums).
/// @param t order-major [order][window] T_b; order 0 is the observed order of the values, the others are
/// random orders
/// @param windows window lengths b, in values
Dependence judged(std::vector<double> t, std::span<const std::size_t> windows) {
  const std::size_t width = windows.size();
  const std::size_t orders = t.size() / width;
  for (std::size_t w = 0; w < width; ++w) {
    double mean = 0.0;
    for (std::size_t i = 0; i < orders; ++i) mean += t[i * width + w] / static_cast<double>(orders);
    double variance = 0.0;
    for (std::size_t i = 0; i < orders; ++i)
      variance += std::pow(t[i * width + w] - mean, 2) / static_cast<double>(orders);
    const double scale = variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
    for (std::size_t i = 0; i < orders; ++i) t[i * width + w] = (t[i * width + w] - mean) * scale;
  }
  const auto largest = [&](std::size_t order) {
    const auto row = std::span(t).subspan(order * width, width);
    return std::ranges::max_element(row, {}, [](double z) { return std::abs(z); }) - row.begin();
  };
  const auto size = [&](std::size_t order) {
    return std::abs(t[order * width + static_cast<std::size_t>(largest(order))]);
  };
  const double observed = size(0);
  std::size_t as_large = 0;
  for (std::size_t i = 0; i < orders; ++i) as_large += size(i) >= observed ? 1 : 0;
  const auto window = static_cast<std::size_t>(largest(0));
  return {.p = static_cast<double>(as_large) / static_cast<double>(orders),
          .over = static_cast<std::int64_t>(windows[window]),
          .alternates = t[window] < 0.0};
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

RankedBag::RankedBag(std::vector<double> values) : size_(std::ssize(values)) {
  if (!std::ranges::is_sorted(values)) std::ranges::sort(values);
  runs_.push_back(std::move(values));
}

RankedBag::Place RankedBag::place_of(double value) const {
  Place place;
  for (const std::vector<double>& run : runs_) {
    const auto [first, last] = std::equal_range(run.begin(), run.end(), value);
    place.above += run.end() - last;
    place.equal += last - first;
  }
  return place;
}

void RankedBag::insert(double value) {
  runs_.push_back({value});
  ++size_;
  // The first run, which may be long, is merged last.
  while (runs_.size() > 1 && runs_.back().size() * 2 > runs_[runs_.size() - 2].size()) {
    std::vector<double> merged;
    merged.reserve(runs_.back().size() + runs_[runs_.size() - 2].size());
    std::ranges::merge(runs_[runs_.size() - 2], runs_.back(), std::back_inserter(merged));
    runs_.pop_back();
    runs_.back() = std::move(merged);
  }
}

ChangeTest::ChangeTest(std::vector<std::vector<double>> baseline, const random::RandomKey& ties)
    : bags_(bags_of(std::move(baseline))),
      martingale_(size_of(bags_)),
      ties_(ties),
      history_(static_cast<std::uint64_t>(size_of(bags_))) {}

double ChangeTest::update(double value, std::size_t of_class) {
  RankedBag& bag = bags_[of_class];
  const RankedBag::Place place = bag.place_of(value);
  const double u = random::open_uniform(random::random_bits({ties_, 0}, history_, random::Draw::trial));
  const double p = (static_cast<double>(place.above) + u * static_cast<double>(place.equal + 1)) /
                   static_cast<double>(bag.size() + 1);
  const auto ranks =
      static_cast<std::uint64_t>(place.above) + (static_cast<std::uint64_t>(place.equal) << 32U);
  history_ = random::random_bits({ties_, 1}, history_ ^ ranks, random::Draw::trial);
  bag.insert(value);
  martingale_.update(p);
  return p;
}

double mid_rank(std::span<const double> sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  return 0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin()));
}

std::vector<double> ranks_within(std::span<const double> values, std::span<const std::size_t> classes) {
  std::vector<double> ranks(values.size());
  for (const std::vector<std::size_t>& places : places_of(classes)) {
    std::vector<double> sorted;
    for (const std::size_t place : places) sorted.push_back(values[place]);
    std::ranges::sort(sorted);
    for (const std::size_t place : places)
      ranks[place] = mid_rank(sorted, values[place]) / static_cast<double>(sorted.size());
  }
  return ranks;
}

double part_between(std::span<const double> values, std::span<const std::size_t> classes) {
  const std::vector<double> ranks = ranks_within(values, std::vector<std::size_t>(values.size(), 0));
  double total = 0.0;
  for (const double rank : ranks) total += (rank - 0.5) * (rank - 0.5);
  double between = 0.0;
  for (const std::vector<std::size_t>& places : places_of(classes)) {
    double sum = 0.0;
    for (const std::size_t place : places) sum += ranks[place] - 0.5;
    if (!places.empty()) between += sum * sum / static_cast<double>(places.size());
  }
  return total > 0.0 ? between / total : 0.0;
}

Dependence dependence_of(std::span<const double> values, std::span<const std::size_t> classes,
                         const random::RandomKey& key) {
  const std::size_t count = std::min(values.size(), max_values);
  if (count < min_values) return {};
  const std::vector<std::vector<std::size_t>> places = places_of(classes.first(count));
  std::vector<double> x = ranks_within(values.first(count), classes.first(count));
  for (double& rank : x) rank -= 0.5;
  if (std::ranges::all_of(x, [](double rank) { return rank == 0.0; })) return {};
  std::vector<std::size_t> windows;
  for (std::size_t window = 2; 3 * window <= count; window *= 2) windows.push_back(window);
  const std::size_t orders = std::clamp(max_work / (count * windows.size()), min_orders, max_orders);
  std::vector<double> t;
  add_windows(x, windows, t);
  random::NumberSource numbers(key);
  for (std::size_t order = 0; order < orders; ++order) {
    for (const std::vector<std::size_t>& alike : places)
      for (std::size_t remaining = alike.size(); remaining > 1; --remaining) {
        const auto other = static_cast<std::size_t>(numbers.uniform() * static_cast<double>(remaining));
        std::swap(x[alike[remaining - 1]], x[alike[std::min(other, remaining - 1)]]);
      }
    add_windows(x, windows, t);
  }
  return judged(std::move(t), windows);
}

}  // namespace zerocount::monitor

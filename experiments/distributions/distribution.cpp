#include "experiments/distributions/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include <boost/math/distributions/triangular.hpp>

#include "core/numerics/elementary_functions.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::distributions {

namespace {

template <class... Cases>
struct Overload : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overload(Cases...) -> Overload<Cases...>;

// Rounding may move a quantile to the upper end of the half-open support or beyond it.
double kept_inside(double value, double low, double high) {
  return std::clamp(value, low, std::nextafter(high, low));
}

std::int64_t place_among(std::int64_t count, double u) {
  return std::min(static_cast<std::int64_t>(u * static_cast<double>(count)), count - 1);
}

template <class Other>
QuantileConstants constants_of(const Other&) {
  return {};
}
QuantileConstants constants_of(const LogUniform& d) {
  return {numerics::log_of_draws(d.low), numerics::log_of_draws(d.high)};
}
QuantileConstants constants_of(const Lognormal& d) {
  return {numerics::log_of_draws(d.median), std::sqrt(numerics::log1p(d.cv * d.cv))};
}
/// The constants of a truncated normal distribution's quantile function: the probabilities P(Z ≤ limit) of
/// its two limits after standardisation. If the range is an upper tail, it is mirrored.
QuantileConstants constants_of(const TruncatedNormal& d) {
  const bool mirrored = d.low > d.mean;
  const double low = (d.low - d.mean) / d.sd;
  const double high = (d.high - d.mean) / d.sd;
  return {numerics::normal_probability(mirrored ? -high : low),
          numerics::normal_probability(mirrored ? -low : high), mirrored};
}

double turned(const QuantileConstants& tail, double u) {
  return tail.mirrored ? 1.0 - u : u;
}

double quantile_of(const Uniform& d, const QuantileConstants&, double u) {
  return kept_inside(d.low + u * (d.high - d.low), d.low, d.high);
}

double quantile_of(const LogUniform& d, const QuantileConstants& logarithms, double u) {
  return kept_inside(numerics::exp_of_draws(std::lerp(logarithms.low, logarithms.high, u)), d.low, d.high);
}

double quantile_of(const Normal& d, const QuantileConstants&, double u) {
  return numerics::normal_quantile(u, d.mean, d.sd);
}

double quantile_of(const TruncatedNormal& d, const QuantileConstants& tail, double u) {
  const double z = numerics::normal_quantile(std::lerp(tail.low, tail.high, turned(tail, u)));
  return kept_inside(d.mean + d.sd * (tail.mirrored ? -z : z), d.low, d.high);
}

double quantile_of(const Lognormal&, const QuantileConstants& logarithm, double u) {
  return numerics::exp_of_draws(numerics::normal_quantile(u, logarithm.low, logarithm.high));
}

double quantile_of(const Triangular& d, const QuantileConstants&, double u) {
  return kept_inside(boost::math::quantile(boost::math::triangular(d.low, d.mode, d.high), u), d.low, d.high);
}

double quantile_of(const Integers& d, const QuantileConstants&, double u) {
  return d.unit * static_cast<double>(d.low + place_among(d.high - d.low + 1, u));
}

double quantile_of(const Choice& d, const QuantileConstants&, double u) {
  return d.values[static_cast<std::size_t>(place_among(static_cast<std::int64_t>(d.values.size()), u))];
}

using Uniformly = std::optional<double>;

Uniformly middle_of_place(std::int64_t place, std::int64_t count) {
  return (static_cast<double>(place) + 0.5) / static_cast<double>(count);
}

Uniformly uniform_of_value(const Uniform& d, double x) {
  return (x - d.low) / (d.high - d.low);
}

Uniformly uniform_of_value(const LogUniform& d, double x) {
  const QuantileConstants logarithms = constants_of(d);
  return (numerics::log_of_draws(x) - logarithms.low) / (logarithms.high - logarithms.low);
}

Uniformly uniform_of_value(const Normal& d, double x) {
  return numerics::normal_probability((x - d.mean) / d.sd);
}

Uniformly uniform_of_value(const TruncatedNormal& d, double x) {
  const QuantileConstants tail = constants_of(d);
  const double z = (x - d.mean) / d.sd;
  const double up_to_x = numerics::normal_probability(tail.mirrored ? -z : z);
  return turned(tail, (up_to_x - tail.low) / (tail.high - tail.low));
}

Uniformly uniform_of_value(const Lognormal& d, double x) {
  const QuantileConstants logarithm = constants_of(d);
  return numerics::normal_probability((numerics::log_of_draws(x) - logarithm.low) / logarithm.high);
}

Uniformly uniform_of_value(const Triangular& d, double x) {
  return boost::math::cdf(boost::math::triangular(d.low, d.mode, d.high), x);
}

Uniformly uniform_of_value(const Integers& d, double x) {
  const double whole = x / d.unit;
  if (whole != std::trunc(whole)) return std::nullopt;
  return middle_of_place(static_cast<std::int64_t>(whole) - d.low, d.high - d.low + 1);
}

Uniformly uniform_of_value(const Choice& d, double x) {
  const auto place = std::ranges::find(d.values, x);
  if (place == d.values.end()) return std::nullopt;
  return middle_of_place(place - d.values.begin(), std::ssize(d.values));
}

}  // namespace

numerics::Interval support(const Distribution& distribution) {
  return std::visit(Overload{[](const Uniform& d) { return numerics::half_open(d.low, d.high); },
                             [](const LogUniform& d) { return numerics::half_open(d.low, d.high); },
                             [](const Normal&) { return numerics::all_numbers(); },
                             [](const TruncatedNormal& d) { return numerics::half_open(d.low, d.high); },
                             [](const Lognormal&) { return numerics::above(0.0); },
                             [](const Triangular& d) { return numerics::half_open(d.low, d.high); },
                             [](const Integers& d) {
                               return numerics::closed(d.unit * static_cast<double>(d.low),
                                                       d.unit * static_cast<double>(d.high));
                             },
                             [](const Choice& d) {
                               const auto [low, high] = std::minmax_element(d.values.begin(), d.values.end());
                               return numerics::closed(*low, *high);
                             }},
                    distribution);
}

QuantileFunction::QuantileFunction(const Distribution& distribution)
    : distribution_(distribution),
      constants_(std::visit([](const auto& d) { return constants_of(d); }, distribution)) {}

double QuantileFunction::operator()(double u) const {
  return std::visit([&](const auto& d) { return quantile_of(d, constants_, u); }, distribution_);
}

double quantile(const Distribution& distribution, double u) {
  return std::visit([u](const auto& d) { return quantile_of(d, constants_of(d), u); }, distribution);
}

std::optional<double> uniform_of(const Distribution& distribution, double x) {
  if (!std::isfinite(x) || !numerics::contains(support(distribution), x)) return std::nullopt;
  const Uniformly u = std::visit([x](const auto& d) { return uniform_of_value(d, x); }, distribution);
  if (!u) return std::nullopt;
  return std::clamp(*u, 0x1p-53, 1.0 - 0x1p-53);
}

Distribution scaled(const Distribution& distribution, double factor) {
  const auto times = [factor](double value) { return factor * value; };
  return std::visit(
      Overload{[&](const Uniform& d) -> Distribution {
                 return Uniform{times(d.low), times(d.high)};
               },
               [&](const LogUniform& d) -> Distribution {
                 return LogUniform{times(d.low), times(d.high)};
               },
               [&](const Normal& d) -> Distribution {
                 return Normal{times(d.mean), times(d.sd)};
               },
               [&](const TruncatedNormal& d) -> Distribution {
                 return TruncatedNormal{times(d.mean), times(d.sd), times(d.low), times(d.high)};
               },
               [&](const Lognormal& d) -> Distribution {
                 return Lognormal{times(d.median), d.cv};
               },
               [&](const Triangular& d) -> Distribution {
                 return Triangular{times(d.low), times(d.mode), times(d.high)};
               },
               [&](const Integers& d) -> Distribution {
                 return Integers{d.low, d.high, times(d.unit)};
               },
               [&](Choice d) -> Distribution {
                 std::ranges::transform(d.values, d.values.begin(), times);
                 return d;
               }},
      distribution);
}

Distribution widened(const Distribution& distribution, double factor) {
  const auto away = [factor](double centre, double value) { return centre + factor * (value - centre); };
  return std::visit(
      Overload{[&](const Uniform& d) -> Distribution {
                 const double centre = 0.5 * (d.low + d.high);
                 return Uniform{away(centre, d.low), away(centre, d.high)};
               },
               [&](const LogUniform& d) -> Distribution {
                 const double more = numerics::pow(d.high / d.low, 0.5 * (factor - 1.0));
                 return LogUniform{d.low / more, d.high * more};
               },
               [&](const Normal& d) -> Distribution {
                 return Normal{d.mean, factor * d.sd};
               },
               [&](const TruncatedNormal& d) -> Distribution {
                 return TruncatedNormal{d.mean, factor * d.sd, away(d.mean, d.low), away(d.mean, d.high)};
               },
               [&](const Lognormal& d) -> Distribution {
                 return Lognormal{d.median,
                                  std::sqrt(numerics::expm1(factor * factor * numerics::log1p(d.cv * d.cv)))};
               },
               [&](const Triangular& d) -> Distribution {
                 return Triangular{away(d.mode, d.low), d.mode, away(d.mode, d.high)};
               },
               [](const Integers& d) -> Distribution { return d; },
               [](const Choice& d) -> Distribution { return d; }},
      distribution);
}

bool extremes_are_inside(const Distribution& distribution, const numerics::Interval& range) {
  try {
    return numerics::contains(range, quantile(distribution, 0x1p-53)) &&
           numerics::contains(range, quantile(distribution, 1.0 - 0x1p-53));
  } catch (const std::exception&) {
    return false;
  }
}

bool whole_numbers_only(const Distribution& distribution) {
  if (const auto* integers = std::get_if<Integers>(&distribution))
    return integers->unit == std::trunc(integers->unit);
  const auto* choice = std::get_if<Choice>(&distribution);
  return choice != nullptr && std::all_of(choice->values.begin(), choice->values.end(),
                                          [](double v) { return v == std::trunc(v); });
}

}  // namespace zerocount::distributions

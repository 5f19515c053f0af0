#include "experiments/parameters/measured_parameters.hpp"

#include <algorithm>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::parameters {
namespace {

MeasuredParameters measured_creep() {
  constexpr std::string_view torque = "friction.measured.creep.torque";
  constexpr std::string_view extension = "friction.measured.creep.extension";
  constexpr std::string_view rate = "friction.measured.creep.rate";
  constexpr std::string_view exponent = "friction.measured.creep.exponent";
  using From = std::span<const double>;
  return {.section = "friction.measured.creep",
          .names = {torque, extension, rate, exponent},
          .following = {{"friction.alpha", {rate}, [](From from) { return from[0]; }},
                        {"friction.lambda",
                         {torque, extension, exponent},
                         [](From from) { return numerics::pow_of_draws(from[0], from[2]) / from[1]; }},
                        {"friction.n", {exponent}, [](From from) { return from[0]; }}}};
}

}  // namespace

std::span<const MeasuredParameters> measured_parameters() {
  static const std::vector<MeasuredParameters> all{measured_creep()};
  return all;
}

bool is_measured(std::string_view name) {
  return std::ranges::any_of(measured_parameters(), [&](const MeasuredParameters& group) {
    return std::ranges::find(group.names, name) != group.names.end();
  });
}

}  // namespace zerocount::parameters

#include "experiments/study/aging.hpp"

#include <numbers>

#include <fmt/format.h>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::study {

double factor_at_age(const Aging& aging, double rate, double age) {
  const double ages = age / aging.scale;
  switch (aging.law) {
    case AgingLaw::exponential:
      return numerics::exp_of_draws(rate * ages);
    case AgingLaw::logarithmic:
      return 1.0 + rate * (numerics::log1p(ages) / std::numbers::ln10);
    case AgingLaw::linear:
      break;
  }
  return 1.0 + rate * ages;
}

std::string age_text(const Ages& ages, double age) {
  return fmt::format("{} {}", age, ages.unit);
}

}  // namespace zerocount::study

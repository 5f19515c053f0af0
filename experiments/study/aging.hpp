#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::study {

/// Laws by which values change with age, of the rate r and the scale s of ages (docs/manifest/ages.md).
enum class AgingLaw : std::uint8_t {
  linear,       ///< v·(1 + r·a/s)
  exponential,  ///< v·exp(r·a/s)
  logarithmic   ///< v·(1 + r·log10(1 + a/s))
};

/// The keys of `aging` that name its law, in the order of AgingLaw.
inline constexpr std::array<std::string_view, 3> aging_law_labels{"linear", "exponential", "logarithmic"};

/// How a value changes with age (`aging`).
struct Aging {
  AgingLaw law{AgingLaw::linear};
  double scale{1.0};      ///< s, in the unit of ages
  std::uint32_t rate{0};  ///< slot of the rate r
};

/// The value at this age divided by that at age 0. Exactly 1 at age 0.
double factor_at_age(const Aging& aging, double rate, double age);

/// The ages at which every machine is simulated (`ages`).
struct Ages {
  std::vector<double> at;      ///< rising, from 0 on; empty: the study has no ages
  std::string unit{"cycles"};  ///< one word
};

/// "100000 cycles": an age with all digits that it has, as columns of ages print it.
std::string age_text(const Ages& ages, double age);

}  // namespace zerocount::study

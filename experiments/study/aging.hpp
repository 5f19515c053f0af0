#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace zerocount::study {

/// Laws by which a value changes from v at age 0 to its value at age a, with the rate r and the scale s of
/// ages (docs/manifest/ages.md).
enum class AgingLaw : std::uint8_t {
  linear,       ///< v·(1 + r·a/s)
  exponential,  ///< v·exp(r·a/s)
  logarithmic   ///< v·(1 + r·log10(1 + a/s))
};

/// The keys inside `aging` that name the law by which a value changes with age, in the order of AgingLaw.
inline constexpr std::array<std::string_view, 3> aging_law_labels{"linear", "exponential", "logarithmic"};

/// The law by which one value of a manifest changes with age (key `aging`).
struct Aging {
  AgingLaw law{AgingLaw::linear};
  double scale{1.0};      ///< scale s of the ages, in the unit of ages
  std::uint32_t rate{0};  ///< index in the plan of the slot that holds the rate r
};

/// Factor by which age multiplies a value: its ratio at this age to the value at age 0. Exactly 1 at age 0.
/// @param rate rate r of the law
double factor_at_age(const Aging& aging, double rate, double age);

/// The ages at which every machine is simulated (`ages`).
struct Ages {
  std::vector<double> at;      ///< ages, rising from 0; empty: the study has no ages
  std::string unit{"cycles"};  ///< unit of ages, one word
};

/// Text of an age with its unit and all its digits, "100000 cycles", as the columns of tables print it.
std::string age_text(const Ages& ages, double age);

}  // namespace zerocount::study

#pragma once

#include <string>
#include <string_view>

namespace zerocount::text {

/// A quantity with the prefix of its unit, from pico to giga, that leaves 1 to 999 before the decimal point:
/// "10 µrad" of 1e-5 and "rad". Numbers have at most 6 digits; without a prefix in that range they have an
/// exponent.
std::string with_si_prefix(double value, std::string_view unit);

}  // namespace zerocount::text

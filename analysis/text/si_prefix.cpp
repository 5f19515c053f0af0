#include "analysis/text/si_prefix.hpp"

#include <cmath>

#include <fmt/format.h>

namespace zerocount::text {
namespace {

struct Prefix {
  std::string_view symbol;
  double size;
};

constexpr Prefix prefixes[] = {{"p", 1e-12}, {"n", 1e-9}, {"µ", 1e-6}, {"m", 1e-3},
                               {"", 1.0},    {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};

}  // namespace

std::string with_si_prefix(double value, std::string_view unit) {
  for (const Prefix& prefix : prefixes) {
    const std::string number = fmt::format("{:g}", value / prefix.size);
    const double rounded = std::abs(std::stod(number));
    if (rounded >= 1.0 && rounded < 1000.0) return fmt::format("{} {}{}", number, prefix.symbol, unit);
  }
  return fmt::format("{:g} {}", value, unit);
}

}  // namespace zerocount::text

#pragma once

#include <array>
#include <cstdint>

/// The tables from which exp and log are computed; cmake/make_tables.cpp prints them while the program is
/// built.
namespace zerocount::numerics {

/// A power of two, stored as value·(1 + tail), accurate to 2⁻¹⁰⁰.
struct PowerOfTwo {
  double value;
  double tail;
};

inline constexpr int table_steps = 128;

/// ln 2/128 as a sum. The first term has 16 trailing zero bits, so its multiples up to 2¹⁷ are exact.
inline constexpr double step_high = 0x1.62e42fefa0000p-8;
inline constexpr double step_low = 0x1.cf79abc9e3b3ap-47;
inline constexpr double steps_per_unit = 0x1.71547652b82fep+7;  // 128/ln 2

/// Table of powers of two: element i is 2^(i/128).
extern const std::array<PowerOfTwo, table_steps> powers_of_two;

/// Table entry for the logarithm: 1/c to 24 bits, with c about the middle of an interval, and ln c as a sum
/// of two doubles. The first term is a multiple of 2⁻⁴².
struct LogarithmStep {
  double reciprocal;
  double high;
  double low;
};

/// Bit pattern of the lower end, 0.70508, of the first interval in the logarithm table. An interval is 2⁴⁵
/// doubles; 1 lies inside of one.
inline constexpr std::uint64_t logarithm_start = std::uint64_t{0x3fe69000} << 32;
inline constexpr int logarithm_interval_bits = 45;
inline constexpr int logarithm_steps = 128;

extern const std::array<LogarithmStep, logarithm_steps> logarithms;

}  // namespace zerocount::numerics

#include "analysis/basis/statistics/sums/exact_sum.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

namespace zerocount::statistics {
namespace {

using boost::multiprecision::cpp_int;

constexpr int digit_bits = 32;
constexpr std::int64_t digit_base = std::int64_t{1} << digit_bits;
constexpr std::int64_t digit_mask = digit_base - 1;
/// Binary exponent of digit 0. Its weight is below that of the last bit of the square of the smallest double,
/// 2^(−2·1074).
constexpr std::int64_t min_exponent = -2176;
/// Number of additions before digits must be carried. An addition changes a digit by less than 2^32, so a
/// digit of 64 bits cannot overflow.
constexpr std::int64_t additions_without_carry = std::int64_t{1} << 30;

/// A double as an integer times a power of 2: |value| = whole·2^exponent.
struct Scaled {
  std::int64_t whole{0};
  std::int64_t exponent{0};
};

/// Divides a double into integer and exponent, by the fields of IEEE 754: 52 bits of the mantissa, whose
/// first bit is not stored, and the exponent.
Scaled scaled(double value) {
  constexpr int stored_bits = 52;
  constexpr std::int64_t first_bit = std::int64_t{1} << stored_bits;
  constexpr std::int64_t bias = 1075, all_exponents = 0x7ff;
  const auto bits = std::bit_cast<std::int64_t>(value);
  const std::int64_t field = (bits >> stored_bits) & all_exponents;
  const std::int64_t stored = bits & (first_bit - 1);
  return field == 0 ? Scaled{stored, 1 - bias} : Scaled{stored | first_bit, field - bias};
}

/// The integer that the digits represent: Σ digits[i]·2^(32·i).
cpp_int whole_number(const std::vector<std::int64_t>& digits) {
  cpp_int number = 0;
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
    number <<= digit_bits;
    number += *digit;
  }
  return number;
}

/// number·2^exponent/divisor, rounded to the nearest double. The quotient is computed with more bits than a
/// double before it is rounded.
double rounded(const cpp_int& number, std::int64_t exponent, std::int64_t divisor) {
  using Wide = boost::multiprecision::cpp_bin_float_100;
  const Wide quotient = Wide(number) / Wide(divisor);
  return static_cast<double>(boost::multiprecision::ldexp(quotient, static_cast<int>(exponent)));
}

}  // namespace

void ExactSum::reach(std::int64_t low, std::int64_t high) {
  if (digits_.empty()) first_ = low;
  if (low < first_) {
    digits_.insert(digits_.begin(), static_cast<std::size_t>(first_ - low), 0);
    first_ = low;
  }
  if (high >= first_ + std::ssize(digits_)) digits_.resize(static_cast<std::size_t>(high - first_ + 1), 0);
}

std::int64_t* ExactSum::digits_at(std::int64_t place, std::int64_t count) {
  if (++additions_ > additions_without_carry) normalise();
  reach(place, place + count - 1);
  return digits_.data() + (place - first_);
}

void ExactSum::begin_digits() {
  const double value = std::exchange(only_, 0.0);
  if (value != 0.0) add_to_digits(value);
}

void ExactSum::add_to_digits(double value) {
  const Scaled number = scaled(value);
  if (number.whole == 0) return;
  const std::int64_t sign = std::signbit(value) ? -1 : 1;
  const std::int64_t place = (number.exponent - min_exponent) / digit_bits;
  const auto shift = static_cast<int>((number.exponent - min_exponent) % digit_bits);
  const std::int64_t low = (number.whole & digit_mask) << shift;  // below 2^63
  const std::int64_t high = ((number.whole >> digit_bits) << shift) + (low >> digit_bits);
  std::int64_t* digit = digits_at(place, 3);
  digit[0] += sign * (low & digit_mask);
  digit[1] += sign * (high & digit_mask);
  digit[2] += sign * (high >> digit_bits);
}

/// Adds the square of the value. With whole = a·2^32 + b, the square is a²·2^64 + 2·a·b·2^32 + b²; it is
/// shifted and spread over four digits.
void ExactSum::add_square_to_digits(double value) {
  const Scaled number = scaled(value);
  if (number.whole == 0) return;
  const auto a = static_cast<std::uint64_t>(number.whole >> digit_bits);  // below 2^21
  const auto b = static_cast<std::uint64_t>(number.whole & digit_mask);
  constexpr auto mask = static_cast<std::uint64_t>(digit_mask);
  const std::uint64_t low = b * b;
  const std::uint64_t middle = 2 * a * b + (low >> digit_bits);  // below 2^55
  const std::uint64_t high = a * a + (middle >> digit_bits);     // below 2^43
  const std::array<std::uint64_t, 4> parts{low & mask, middle & mask, high & mask, high >> digit_bits};
  const std::int64_t from_first = 2 * number.exponent - min_exponent;
  const auto shift = static_cast<int>(from_first % digit_bits);
  std::int64_t* digit = digits_at(from_first / digit_bits, 5);
  std::uint64_t carried = 0;
  for (const std::uint64_t part : parts) {
    carried += part << shift;  // below 2^64
    *digit++ += static_cast<std::int64_t>(carried & mask);
    carried >>= digit_bits;
  }
  *digit += static_cast<std::int64_t>(carried);
}

void ExactSum::add(double value) {
  if (value == 0.0) return;
  if (digits_.empty() && only_ == 0.0) {
    only_ = value;
    return;
  }
  begin_digits();
  add_to_digits(value);
}

void ExactSum::add_square(double value) {
  begin_digits();
  add_square_to_digits(value);
}

bool ExactSum::is_valid() const {
  const auto is_digit = [](std::int64_t digit) { return digit > -digit_base && digit < digit_base; };
  constexpr std::int64_t max_digits = last_place + 4;  // of sums of up to 2^63 squares
  return first_ >= 0 && std::ssize(digits_) <= max_digits && first_ <= max_digits - std::ssize(digits_) &&
         std::all_of(digits_.begin(), digits_.end(), is_digit);
}

void ExactSum::normalise() {
  constexpr std::int64_t half = digit_base / 2;
  begin_digits();
  additions_ = 0;
  for (std::size_t i = 0; i < digits_.size(); ++i) {
    const std::int64_t carry = digits_[i] >> digit_bits;
    const bool is_last = i + 1 == digits_.size();
    if (is_last && digits_[i] >= -half && digits_[i] < half) break;
    if (is_last) digits_.push_back(0);
    digits_[i] &= digit_mask;
    digits_[i + 1] += carry;
  }
  // The last digit has the sign; one that the digit before could have is too many.
  while (digits_.size() > 1) {
    const std::int64_t joined = digits_.back() * digit_base + digits_[digits_.size() - 2];
    if (joined < -half || joined >= half) break;
    digits_.pop_back();
    digits_.back() = joined;
  }
  const auto used =
      std::find_if(digits_.begin(), digits_.end(), [](std::int64_t digit) { return digit != 0; });
  first_ = used == digits_.end() ? 0 : first_ + (used - digits_.begin());
  digits_.erase(digits_.begin(), used);
}

ExactSum& ExactSum::operator+=(const ExactSum& other) {
  if (other.digits_.empty()) {
    add(other.only_);
    return *this;
  }
  begin_digits();
  // The digits of a sum are below 2^32 for each addition, and for what normalise() left.
  if (additions_ + other.additions_ + 1 > additions_without_carry) {
    ExactSum added = other;
    added.normalise();
    normalise();
    return add_digits(added);
  }
  return add_digits(other);
}

ExactSum& ExactSum::add_digits(const ExactSum& other) {
  if (other.digits_.empty()) return *this;
  additions_ += other.additions_ + 1;
  reach(other.first_, other.first_ + std::ssize(other.digits_) - 1);
  std::int64_t* const digits = digits_.data() + (other.first_ - first_);
  for (std::size_t i = 0; i < other.digits_.size(); ++i) digits[i] += other.digits_[i];
  return *this;
}

double ExactSum::value() const {
  if (digits_.empty()) return only_;
  return rounded(whole_number(digits_), min_exponent + digit_bits * first_, 1);
}

bool operator==(ExactSum one, ExactSum other) {
  one.normalise();
  other.normalise();
  return one.first_ == other.first_ && one.digits_ == other.digits_;
}

double squared_deviations(ExactSum sum, ExactSum squares, std::int64_t n) {
  sum.begin_digits();
  squares.begin_digits();
  const cpp_int total = whole_number(sum.digits_);
  // The places of the last digits of n·Σx² and of (Σx)².
  const std::int64_t of_squares = squares.first_ - min_exponent / digit_bits;
  const std::int64_t of_total = 2 * sum.first_;
  const std::int64_t last = std::min(of_squares, of_total);
  const auto shift = [&](std::int64_t place) { return static_cast<unsigned>(digit_bits * (place - last)); };
  const cpp_int number =
      ((whole_number(squares.digits_) * n) << shift(of_squares)) - ((total * total) << shift(of_total));
  return rounded(number, 2 * min_exponent + digit_bits * last, n);
}

}  // namespace zerocount::statistics

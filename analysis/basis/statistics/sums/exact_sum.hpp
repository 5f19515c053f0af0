#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

namespace zerocount::statistics {

/// The exact sum of finite doubles and of their squares. It does not depend on the order of the additions, so
/// the statistics of parts of a sample can be combined to exactly those of the whole.
///
/// A fixed-point number of as many digits as the values need: the digit at place i is worth 2^(32·i − 2176).
/// Source: Kulisch, Computer Arithmetic and Validity (2008), section 8.
class ExactSum {
 public:
  /// Adds a value to the sum.
  /// @param value finite
  void add(double value);
  void add_square(double value);
  ExactSum& operator+=(const ExactSum& other);

  /// The sum, rounded to the nearest double.
  double value() const;

  friend bool operator==(ExactSum one, ExactSum other);
  friend double squared_deviations(ExactSum sum, ExactSum squares, std::int64_t n);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    if constexpr (std::is_const_v<Self>) {
      ExactSum sum = self;
      sum.normalise();
      archive(sum.first_, sum.digits_);
    } else {
      self.only_ = 0.0;
      archive(self.first_, self.digits_);
      archive.require(self.is_valid());
    }
  }

 private:
  /// Whether digits restored from a file, and their places, are within their ranges.
  bool is_valid() const;
  /// Brings the digits into the unique form of the number, which does not depend on the summands.
  void normalise();
  ExactSum& add_digits(const ExactSum& other);
  void add_to_digits(double value);
  void add_square_to_digits(double value);
  /// Converts the single value `only_` to digits, before a second value is added.
  void begin_digits();
  /// Pointer to the `count` digits from `place` on, made room for, so that less than 2^32 can be added to
  /// each.
  std::int64_t* digits_at(std::int64_t place, std::int64_t count);
  void reach(std::int64_t low, std::int64_t high);

  /// Place of the digit for 2^2048, which exceeds the largest square.
  static constexpr std::int64_t last_place = 4224 / 32;

  double only_{0.0};  ///< The sum as long as only one value was added, so that it takes no memory for digits.
  std::vector<std::int64_t> digits_;
  /// Place of the first digit in `digits_`; digit i is worth 2^(32·(first_ + i) − 2176).
  std::int64_t first_{0};
  /// Number of additions since the last normalise(), so that the digits do not overflow.
  std::int64_t additions_{0};
};

/// Sum of the squared deviations from the mean, Σ(xᵢ − x̄)² = Σxᵢ² − (Σxᵢ)²/n, rounded to the nearest double.
/// @param squares sum of the squared values
/// @param n number of values
double squared_deviations(ExactSum sum, ExactSum squares, std::int64_t n);

}  // namespace zerocount::statistics

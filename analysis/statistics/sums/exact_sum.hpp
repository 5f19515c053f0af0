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
  /// @param value finite
  void add(double value);
  void add_square(double value);
  ExactSum& operator+=(const ExactSum& other);

  /// Rounded to the nearest double.
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
  /// Whether the restored digits and their places are within their ranges.
  bool is_valid() const;
  /// Brings the digits into the unique form of the number, which does not depend on the summands.
  void normalise();
  ExactSum& add_digits(const ExactSum& other);
  void add_to_digits(double value);
  void add_square_to_digits(double value);
  /// Converts the only summand `only_` to digits.
  void begin_digits();
  /// The `count` digits from `place` on, for adding less than 2^32 to each.
  std::int64_t* digits_at(std::int64_t place, std::int64_t count);
  void reach(std::int64_t low, std::int64_t high);

  /// Place of the digit for 2^2048, which exceeds the largest square.
  static constexpr std::int64_t last_place = 4224 / 32;

  double only_{0.0};  ///< the sum while it has no digits: a sum of one value takes no memory for them
  std::vector<std::int64_t> digits_;
  std::int64_t first_{0};  ///< place of the first digit
  /// Number of additions since the last normalise(), so that the digits do not overflow.
  std::int64_t additions_{0};
};

/// Σ(xᵢ − x̄)² = Σxᵢ² − (Σxᵢ)²/n, rounded to the nearest double.
double squared_deviations(ExactSum sum, ExactSum squares, std::int64_t n);

}  // namespace zerocount::statistics

#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

namespace zerocount::statistics {

/// The exact sum of finite doubles and of their squares. It does not depend on the order of the additions, so
/// that the statistics of parts of a sample, put together, are those of the whole.
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
  /// Brings the digits into the one form that stands for the number, whatever it was the sum of.
  void normalise();
  ExactSum& add_digits(const ExactSum& other);
  void add_to_digits(double value);
  void add_square_to_digits(double value);
  /// Brings the only summand into digits.
  void begin_digits();
  /// The digits from this place on, `count` of them, to add less than 2^32 to each.
  std::int64_t* digits_at(std::int64_t place, std::int64_t count);
  void reach(std::int64_t low, std::int64_t high);

  static constexpr std::int64_t last_place = 4224 / 32;  ///< of 2^2048, above the largest square

  double only_{0.0};  ///< the sum while it has no digits: a sum of one value takes no memory for them
  std::vector<std::int64_t> digits_;
  std::int64_t first_{0};      ///< place of the first digit
  std::int64_t additions_{0};  ///< since the last normalise(): the digits must not overflow
};

/// Σ(xᵢ − x̄)² = Σxᵢ² − (Σxᵢ)²/n, rounded to the nearest double.
double squared_deviations(ExactSum sum, ExactSum squares, std::int64_t n);

}  // namespace zerocount::statistics

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/study_fwd.hpp"

namespace zerocount::randomness {

/// A draw of one of a number of equally probable rows: the entries of a choice, the numbers of `integers`,
/// the rows of joint samples. Entries that are equal are rows of one value, which is the more probable.
struct DiscreteDraw {
  std::string name{};  ///< of its coordinate
  /// Row ⌊rows·Φ(Σ factor·z)⌋ is drawn, over (coordinate, factor); the squares of the factors have the sum 1.
  /// One coordinate, unless the draw is correlated with others.
  std::vector<std::pair<std::size_t, double>> direction{};
  std::int64_t rows{1};
  bool ordered{false};  ///< neighbours are alike: whole numbers, and choices that are sorted
  std::vector<std::uint32_t> values_of_rows{};  ///< [row] of a choice; empty: row r is value r
  std::vector<double> numbers{};                ///< [value] of a choice
  std::int64_t first{0};                        ///< number of row 0, of `integers`

  std::int64_t values() const { return numbers.empty() ? rows : std::ssize(numbers); }
};

/// The discrete draws among the coordinates of a design point.
std::vector<DiscreteDraw> discrete_draws(const study::Study& study, std::int64_t point,
                                         std::span<const RandomCoordinate> coordinates);

/// The value of a row.
std::int64_t value_of_row(const DiscreteDraw& draw, std::int64_t row);

/// The value that is drawn at these coordinates.
std::int64_t value_at(const DiscreteDraw& draw, std::span<const double> z);

/// Moves independent standard normal coordinates to where this row is drawn, as if they had been drawn under
/// the condition that it is. @param uniform in (0, 1), independent of them
void move_to_row(const DiscreteDraw& draw, std::int64_t row, double uniform, std::span<double> z);

/// "0.35", or "row 17" of joint samples.
std::string value_text(const DiscreteDraw& draw, std::int64_t value);

}  // namespace zerocount::randomness

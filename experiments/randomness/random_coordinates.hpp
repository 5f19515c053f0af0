#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::randomness {

/// One random coordinate of a trial: a standard normal number, from which values of the trial follow.
struct RandomCoordinate {
  enum class Kind : std::uint8_t {
    values,           ///< of `slots`: their quantile is Φ(z), after the correlations of the study
    profile_mean,     ///< of the profile of slots[0]: the quantile of its mean is Φ(z)
    profile_at_start  ///< of the profile of slots[0]: the field where the trial begins is z
  };
  std::string name;  ///< dotted path; of joint samples the paths, joined by ", "
  Kind kind{Kind::values};
  std::vector<std::uint32_t> slots;
  std::int64_t rows{
      0};  ///< of joint samples, in an order that means nothing; row ⌊rows·Φ(z)⌋ is drawn; otherwise 0
  bool of_machine{
      false};  ///< the same in all trials of a machine; without machines see differs_between_machines()
};

/// The random coordinates of the trials of a design point: all that is drawn for each machine, trial or
/// contact (of a contact, the first of a trial). Independent of each other. What is drawn for the study or
/// for a world is not among them, nor are the random numbers used while a trial runs.
std::vector<RandomCoordinate> random_coordinates(const study::Study& study, std::int64_t point);

/// Φ(z), a uniform number in the open interval (0, 1) whatever z.
double uniform_of_score(double z);

/// Gives a trial the random number of a coordinate. @param uniform its uniform number @param score its normal
/// one, which is that of a profile where the trial begins
void give(study::GivenDraws& draws, const RandomCoordinate& coordinate, double uniform, double score);

/// The random numbers of a trial at these coordinates. The trial has the point's distribution if the
/// coordinates are independent standard normal numbers.
/// @param coordinates of the study at the point @param z [coordinate]
/// @param number of the trial, for all random numbers beside the coordinates; of its rotor too
study::GivenDraws draws_at(const study::Study& study, std::span<const RandomCoordinate> coordinates,
                           std::span<const double> z, std::int64_t number);

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

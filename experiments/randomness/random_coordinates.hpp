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

/// One random coordinate of a trial: a standard normal number z from which values of the trial are computed.
struct RandomCoordinate {
  enum class Kind : std::uint8_t {
    /// The values of `slots` (parameters in the plan); their quantile is Φ(z), after z is correlated as in
    /// the study.
    values,
    profile_mean,  ///< the mean of the profile of slots[0] along the axis; its quantile is Φ(z)
    /// The Gaussian random field of the profile of slots[0]; its value at the position where the trial begins
    /// is z.
    profile_at_start
  };
  std::string name;  ///< dotted path of the parameter; for joint samples all paths, joined by ", "
  Kind kind{Kind::values};
  std::vector<std::uint32_t> slots;
  /// Number of rows of joint samples, of which row ⌊rows·Φ(z)⌋ is drawn; otherwise 0. The order of the rows
  /// has no meaning.
  std::int64_t rows{0};
  /// The coordinate is the same in all trials of a machine; without machines see differs_between_machines().
  bool of_machine{false};
};

/// The random coordinates of the trials of a design point: one for each quantity that is drawn per machine,
/// per trial or per contact (only the first contact of a trial). They are independent of each other.
/// Quantities drawn for the study or for a world are not included, nor are the random numbers used while a
/// trial runs.
std::vector<RandomCoordinate> random_coordinates(const study::Study& study, std::int64_t point);

/// Φ(z), clamped so that the result is in the open interval (0, 1) for every z.
double uniform_of_score(double z);

/// Stores the random number of one coordinate in `draws`, the given random numbers of a trial.
/// @param uniform uniform number in (0, 1), used for values and means of profiles
/// @param score standard normal number, used for the field of a profile where the trial begins
void give(study::GivenDraws& draws, const RandomCoordinate& coordinate, double uniform, double score);

/// The random numbers of a trial at these coordinates. The trial has the point's distribution if the
/// coordinates are independent standard normal numbers.
/// @param coordinates random_coordinates() of the study
/// @param z [coordinate] standard normal number
/// @param number draw that supplies all other random numbers, and index of the trial's rotor
study::GivenDraws draws_at(const study::Study& study, std::span<const RandomCoordinate> coordinates,
                           std::span<const double> z, std::int64_t number);

/// A random draw of one out of several equally probable rows. The rows are the entries of a choice, the
/// numbers of `integers`, or the rows of joint samples. Equal entries of a choice are several rows with one
/// value, so this value is more probable.
struct DiscreteDraw {
  std::string name{};  ///< name of the draw's coordinate (RandomCoordinate::name)
  /// Pairs of coordinate and factor: row ⌊rows·Φ(Σ factor·z[coordinate])⌋ is drawn. The squares of the
  /// factors have the sum 1. There is one pair, unless the draw is correlated with others.
  std::vector<std::pair<std::size_t, double>> direction{};
  std::int64_t rows{1};
  bool ordered{false};  ///< adjacent rows have adjacent values: whole numbers, or a sorted choice
  /// [row] index of the row's value in `numbers`; empty: row r has value r.
  std::vector<std::uint32_t> values_of_rows{};
  /// [index of a value] the number, if the draw is from a choice; otherwise empty.
  std::vector<double> numbers{};
  std::int64_t first{0};  ///< the number that row 0 stands for, if the draw is from `integers`

  std::int64_t values() const { return numbers.empty() ? rows : std::ssize(numbers); }
};

/// The discrete draws (choices, whole numbers, rows of joint samples) among the random coordinates of a
/// design point.
std::vector<DiscreteDraw> discrete_draws(const study::Study& study, std::int64_t point,
                                         std::span<const RandomCoordinate> coordinates);

/// The index of the value that a row of the discrete draw gives; several rows can give one value.
std::int64_t value_of_row(const DiscreteDraw& draw, std::int64_t row);

/// The index of the value that the discrete draw gives at the independent standard normal coordinates z.
std::int64_t value_at(const DiscreteDraw& draw, std::span<const double> z);

/// Moves independent standard normal coordinates so that the given row is drawn. The moved coordinates have
/// the distribution conditional on this row.
/// @param uniform uniform number in (0, 1), independent of z
void move_to_row(const DiscreteDraw& draw, std::int64_t row, double uniform, std::span<double> z);

/// Text of a value of the discrete draw: "0.35", or "row 17" for joint samples.
/// @param value index of the value
std::string value_text(const DiscreteDraw& draw, std::int64_t value);

}  // namespace zerocount::randomness

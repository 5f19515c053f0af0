#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/trial/error_bands.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/outcome.hpp"

/// A changed trial may measure in other units than its study: with a finer encoder in finer counts, with a
/// faster controller in shorter samples. The goal of the study still speaks of the study's counts.
///
/// An error of e' finer counts, n of which are a count of the study, is an error of e counts of the study:
///
///   |e| = 0 where |e'| ≤ n/2,   |e| ≤ b where |e'| ≤ n·b + n/2,   sgn e = sgn e',
///
/// so that zero counts have the length of ± half a count of the study, and a band keeps its length. The
/// measures that zero counts define are those of the band 0 (core/trial/measures.md).
namespace zerocount::tuning {

/// Units of a changed trial.
struct FinerUnits {
  std::int64_t counts{1};   ///< Counts of the changed trial in one count of the study; 1 or even.
  std::int64_t samples{1};  ///< Samples of the changed trial in one sample of the study.

  bool operator==(const FinerUnits&) const = default;
};

/// The error in counts of the study.
std::int64_t error_in_study_counts(std::int64_t finer_error, std::int64_t counts);

/// The bands of a changed trial that stand for the bands 0 and 1 and those of the study. Nothing where there
/// are more of them than a trial can measure.
std::optional<trial::ErrorBands> finer_bands(const trial::ErrorBands& of_study, std::int64_t counts);

/// Whether the measure can be told in counts of the study: not where it depends on the zero counts of single
/// samples.
bool is_known_in_study_units(std::string_view measure);

/// The measures of a move in the units of the study. Measures that cannot be told are NaN.
/// @param finer the move, with finer_bands() of the study
/// @param timing the changed move's
trial::MoveOutcome in_study_units(const trial::MoveOutcome& finer, const FinerUnits& units,
                                  const trial::ErrorBands& of_study, const trial::MoveTiming& timing);

}  // namespace zerocount::tuning

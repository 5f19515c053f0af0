#include "analysis/undecided.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "analysis/text.hpp"
#include "core/trial/last_half.hpp"
#include "core/trial/parameters.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

/// Proportion of the moves still falling for which the advised hold is long enough.
constexpr double advised_proportion = 0.9;

/// Rounded up to two significant digits.
double rounded_up(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / digit - 1e-9) * digit;
}

bool falls(const MoveOutcome& move) {
  return std::abs(move.final_error) < std::abs(move.midway_error);
}

/// What is gathered of a point.
struct PointMoves {
  UndecidedMoves counts;
  std::vector<double> needed;  ///< holds, s

  void add(const MoveOutcome& move, std::size_t number, const TrialParameters& parameters);
  UndecidedMoves result();
};

void PointMoves::add(const MoveOutcome& move, std::size_t number, const TrialParameters& parameters) {
  ++counts.off_target;
  if (!falls(move)) return;
  ++counts.still_falling;
  if (!(parameters.controller.ki > 0.0)) return;
  const double zero = time_to_zero(move.midway_error, move.final_error, samples_of_move(parameters, number),
                                   1.0 / parameters.controller.sample_rate);
  needed.push_back(zero + std::max(parameters.verdict.dwell, parameters.verdict.window));
}

UndecidedMoves PointMoves::result() {
  if (needed.empty()) return counts;
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(advised_proportion * static_cast<double>(needed.size())) - 1.0);
  std::nth_element(needed.begin(), needed.begin() + rank, needed.end());
  counts.advised_hold = rounded_up(needed[static_cast<std::size_t>(rank)]);
  return counts;
}

}  // namespace

double time_to_zero(std::int64_t midway_error, std::int64_t final_error, std::int64_t samples,
                    double sample_time) {
  const auto midway = static_cast<double>(std::abs(midway_error));
  const auto final = static_cast<double>(std::abs(final_error));
  const auto last = static_cast<double>(samples - 1) * sample_time;
  const double elapsed = static_cast<double>(samples - 1 - first_of_last_half(samples)) * sample_time;
  return last + elapsed * std::log(2.0 * final) / std::log(midway / final);
}

std::vector<UndecidedMoves> undecided_moves(const StudyFile& file, const Study& study) {
  const std::int64_t trials = file.header().trials;
  const auto moves = static_cast<std::size_t>(file.moves());
  std::vector<PointMoves> points(study.point_labels.size());
  for (PointMoves& point : points) point.counts.moves = trials * file.moves();
  const std::int64_t rows_at_once = chunk_rows(file.moves());
  for (std::int64_t first = 0; first < file.rows().end(); first += rows_at_once) {
    const RowRange block{first, std::min(rows_at_once, file.rows().end() - first)};
    const std::vector<MoveOutcome> outcomes = file.outcomes(block);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].outcome != Outcome::off_target) continue;
      const std::int64_t row = block.first + static_cast<std::int64_t>(i / moves);
      points[static_cast<std::size_t>(row / trials)].add(
          outcomes[i], i % moves, study_trial(study, row / trials, row % trials).parameters);
    }
  }
  std::vector<UndecidedMoves> results;
  results.reserve(points.size());
  for (PointMoves& point : points) results.push_back(point.result());
  return results;
}

std::string undecided_sentence(const UndecidedMoves& moves) {
  if (moves.off_target == 0) return {};
  const std::string off =
      fmt::format("{} of {} moves ended more than one count off their target without oscillating",
                  moves.off_target, moves.moves);
  if (moves.still_falling == 0)
    return off + "; in none of them was the error still falling: they have stalled";
  std::string text =
      off + fmt::format("; the error was still falling in {} of {} moves at the end of the hold",
                        moves.still_falling, moves.moves);
  if (!std::isnan(moves.advised_hold)) text += fmt::format("; hold ≥ about {:.4g} s", moves.advised_hold);
  return text;
}

SummarySection undecided_section(std::span<const PointSummary> points,
                                 const std::vector<std::string>& labels) {
  SummarySection section{.key = "undecided", .json = {}, .columns = {}, .text = {}};
  PointColumn off_target{"undecided_moves", "1", "moves that ended off target", {}};
  PointColumn falling{"still_falling_moves", "1", "of them, with an error that was still falling", {}};
  PointColumn hold{"hold_at_least", "s", "hold that most of these are expected to need", {}};
  bool any = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const UndecidedMoves& point = points[i].undecided;
    section.json.push_back({{"moves", point.moves},
                            {"off_target", point.off_target},
                            {"still_falling", point.still_falling},
                            {"hold_at_least", point.advised_hold}});
    off_target.values.push_back(static_cast<double>(point.off_target));
    falling.values.push_back(static_cast<double>(point.still_falling));
    hold.values.push_back(point.advised_hold);
    if (point.off_target == 0) continue;
    any = true;
    section.text += fmt::format("{}: {}\n", printable(labels[i]), undecided_sentence(point));
  }
  if (any) {
    section.text +=
        "Such moves are undecided: neither stable nor shown unstable. A longer hold decides those whose "
        "error "
        "was still\nfalling\n";
  }
  section.columns = {std::move(off_target), std::move(falling), std::move(hold)};
  return section;
}

}  // namespace zerocount

#include "analysis/sensitivity/trial_outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "results/layout/table_io.hpp"

namespace zerocount {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

using Moves = std::span<const MoveOutcome>;

bool all_of(Moves moves, bool (*holds)(const MoveOutcome&)) {
  return std::all_of(moves.begin(), moves.end(), holds);
}

double largest(Moves moves, double (*value)(const MoveOutcome&)) {
  double most = 0.0;
  for (const MoveOutcome& move : moves) {
    const double of_move = value(move);
    if (std::isnan(of_move)) return none;
    most = std::max(most, of_move);
  }
  return most;
}

// Every move ran to its end, and its motion is known.
bool is_whole(const MoveOutcome& move) {
  return !move.stopped && move.outcome != Outcome::nonfinite;
}
bool is_judged(const MoveOutcome& move) {
  return move.outcome != Outcome::open_loop;
}

double success(Moves moves) {
  if (!all_of(moves, is_judged)) return none;
  return succeeded(moves) ? 1.0 : 0.0;
}
double arrived(Moves moves) {
  if (!all_of(moves, is_judged)) return none;
  return has_arrived(moves) ? 1.0 : 0.0;
}
double stable(Moves moves) {
  if (!all_of(moves, is_judged)) return none;
  return was_stable(moves) ? 1.0 : 0.0;
}
double broke_away(Moves moves) {
  return all_of(moves, [](const MoveOutcome& m) { return !m.broke_away; }) ? 0.0 : 1.0;
}
double jerks(Moves moves) {
  double sum = 0.0;
  for (const MoveOutcome& move : moves) sum += static_cast<double>(move.jerk_count);
  return all_of(moves, is_judged) ? sum : none;
}
double overshoot(Moves moves) {
  return all_of(moves, is_judged)
             ? largest(moves, [](const MoveOutcome& m) { return static_cast<double>(m.overshoot); })
             : none;
}
double true_error(Moves moves) {
  return largest(moves, [](const MoveOutcome& m) { return std::abs(m.true_error); });
}
double peak_torque(Moves moves) {
  return largest(moves, [](const MoveOutcome& m) { return m.peak_torque; });
}
double holding_torque(Moves moves) {
  return moves.back().holding_torque;
}
double creep(Moves moves) {
  return moves.back().creep;
}
double final_position(Moves moves) {
  return moves.back().final_position;
}

struct OutputRow {
  SensitivityOutput output;
  double (*value)(Moves);  // null: settling_time
  bool of_whole_trials{false};
};

constexpr std::array<OutputRow, 12> rows{{
    {{"success", "1", "all moves ended at zero counts", true}, success, false},
    {{"settling_time", "s",
      "time until arrival, the longest of the trial's moves; a move that never arrived counts with its "
      "duration",
      false},
     nullptr,
     false},
    {{"arrived", "1", "all moves arrived", true}, arrived, false},
    {{"stable", "1", "all moves arrived and stayed within one count", true}, stable, false},
    {{"broke_away", "1", "the hook slid in some move", true}, broke_away, false},
    {{"jerk_count", "1", "jerks of all moves", false}, jerks, true},
    {{"overshoot", "count", "largest excursion beyond a target", false}, overshoot, true},
    {{"true_error", "count", "largest distance from the middle of a target's count at the end of a move",
      false},
     true_error,
     true},
    {{"peak_torque", "N m", "largest absolute torque decided", false}, peak_torque, true},
    {{"holding_torque", "N m", "torque decided at the last sample of the last move", false},
     holding_torque,
     true},
    {{"creep", "rad", "plastic extension at the last sample of the last move", false}, creep, true},
    {{"final_position", "rad", "rotor angle at the last sample of the last move", false},
     final_position,
     true},
}};

const OutputRow& find_row(std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const OutputRow& row) { return row.output.name == name; });
  if (found != rows.end()) return *found;
  std::vector<std::string_view> names;
  names.reserve(rows.size());
  for (const OutputRow& row : rows) names.push_back(row.output.name);
  throw Failure(ExitCode::bad_input, fmt::format("there is no output '{}' of a trial; expected one of {}",
                                                 name, fmt::join(names, ", ")));
}

// Of a trial of the closed loop. Only where a move never arrived do its parameters have to be worked out.
double settling_time(Moves moves, const Study& study, std::int64_t point, std::int64_t index,
                     TrialOutputs& outputs) {
  double longest = 0.0;
  double duration = none;
  for (const MoveOutcome& move : moves) {
    if (!is_judged(move)) return none;
    if (!move.arrived && std::isnan(duration)) {
      duration = move_duration(study_trial(study, point, index).parameters);
    }
    longest = std::max(longest, move.arrived ? move.settling_time : duration);
  }
  outputs.never_arrived += !std::isnan(duration);
  return longest;
}

}  // namespace

double move_duration(const TrialParameters& trial) {
  const double rate = trial.controller.sample_rate;
  return std::round(trial.command.hold * rate) / rate;
}

std::span<const SensitivityOutput> sensitivity_outputs() {
  static const auto outputs = [] {
    std::array<SensitivityOutput, rows.size()> all{};
    for (std::size_t i = 0; i < rows.size(); ++i) all[i] = rows[i].output;
    return all;
  }();
  return outputs;
}

const SensitivityOutput& find_sensitivity_output(std::string_view name) {
  return find_row(name).output;
}

TrialOutputs trial_outputs(const StudyFile& file, const Study& study, std::int64_t point,
                           const SensitivityOutput& output) {
  const OutputRow& row = find_row(output.name);
  const std::int64_t trials = file.header().trials;
  const auto moves = static_cast<std::size_t>(file.moves());
  const std::int64_t at_once = chunk_rows(file.moves());
  TrialOutputs outputs;
  for (std::int64_t first = 0; first < trials; first += at_once) {
    const RowRange block{point * trials + first, std::min(at_once, trials - first)};
    const std::vector<MoveOutcome> outcomes = file.outcomes(block);
    for (std::int64_t i = 0; i < block.count; ++i) {
      const Moves of_trial = Moves(outcomes).subspan(static_cast<std::size_t>(i) * moves, moves);
      if (row.of_whole_trials && !all_of(of_trial, is_whole)) {
        outputs.values.push_back(none);
      } else if (row.value == nullptr) {
        outputs.values.push_back(settling_time(of_trial, study, point, first + i, outputs));
      } else {
        outputs.values.push_back(row.value(of_trial));
      }
    }
  }
  return outputs;
}

}  // namespace zerocount

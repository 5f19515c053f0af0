#include "results/reading/validation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <variant>

#include <fmt/format.h>

namespace zerocount {
namespace {

constexpr std::int64_t rows_at_once = chunk_elements;
constexpr std::int64_t numbered_blocks = 8;

/// What one column of a record must be.
template <class Record>
struct ValueRule {
  std::string_view column;
  bool (*sound)(const Record& record);
  std::string_view expected;
};

bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

constexpr std::string_view a_count = "a count, not negative";
constexpr std::string_view a_time = "a finite time, not negative";

using M = MoveOutcome;

constexpr ValueRule<M> measure_rules[] = {
    {"outcome",
     [](const M& m) { return m.outcome >= Outcome::zero_count && m.outcome <= Outcome::off_target; },
     "0 to 5"},
    {"arrival", [](const M& m) { return m.arrival >= -1; }, "a sample, or -1"},
    {"settling_time", [](const M& m) { return std::isnan(m.settling_time) || not_negative(m.settling_time); },
     "a finite time, not negative, or NaN"},
    {"final_settling_time",
     [](const M& m) { return std::isnan(m.final_settling_time) || not_negative(m.final_settling_time); },
     "a finite time, not negative, or NaN"},
    {"zero_fraction", [](const M& m) { return !(m.zero_fraction < 0.0 || m.zero_fraction > 1.0); },
     "a fraction, or NaN"},
    {"oscillation_amplitude",
     [](const M& m) { return std::isnan(m.oscillation_amplitude) || not_negative(m.oscillation_amplitude); },
     "a finite amplitude, not negative, or NaN"},
    {"oscillation_period",
     [](const M& m) { return std::isnan(m.oscillation_period) || not_negative(m.oscillation_period); },
     "a finite time, not negative, or NaN"},
    {"overshoot", [](const M& m) { return m.overshoot >= 0; }, a_count},
    {"travel_time", [](const M& m) { return not_negative(m.travel_time); }, a_time},
    {"phase_changes", [](const M& m) { return m.phase_changes >= 0; }, a_count},
    {"encoder_disagreement", [](const M& m) { return m.encoder_disagreement >= 0; }, a_count},
    {"reversal_depth", [](const M& m) { return m.reversal_depth >= 0; }, a_count},
    {"jerk_count", [](const M& m) { return m.jerk_count >= 0; }, a_count},
    {"jerk_agreement", [](const M& m) { return !(m.jerk_agreement < 0.0 || m.jerk_agreement > 1.0); },
     "a proportion, or NaN"},
};

/// Of two measures, and so of no use where only one is known.
constexpr ValueRule<M> arrival_rule{"arrived",
                                    [](const M& m) { return m.arrived != std::isnan(m.settling_time); },
                                    "1 exactly where there is a settling time"};

using J = JerkRecord;

constexpr ValueRule<J> jerk_rules[] = {
    {"onset", [](const J& j) { return not_negative(j.onset); }, a_time},
    {"duration", [](const J& j) { return not_negative(j.duration); }, a_time},
    {"magnitude", [](const J& j) { return j.magnitude >= 0; }, a_count},
    {"direction", [](const J& j) { return j.direction >= -1 && j.direction <= 1; }, "-1, 0 or 1"},
};

template <class Record>
std::string text_of(const RecordField<Record>& field, const Record& record) {
  return std::visit([&](auto member) { return fmt::format("{}", static_cast<double>(record.*member)); },
                    field.member);
}

/// The column of `table` with this name: one of `fields`, or none.
template <class Record>
std::size_t place_of(const std::vector<RecordField<Record>>& fields, std::string_view name) {
  return static_cast<std::size_t>(
      std::find_if(fields.begin(), fields.end(),
                   [name](const auto& field) { return field.column.name == name; }) -
      fields.begin());
}

[[noreturn]] void fail(const hdf5::Dataset& dataset, const std::string& row, const std::string& value,
                       std::string_view expected) {
  dataset.fail(fmt::format("{}: it is {}; expected {}", row, value, expected));
}

void require_sound(const TableIo& outcomes, const std::vector<RecordField<M>>& fields,
                   const ValueRule<M>& rule, std::int64_t first_row, std::span<const M> moves) {
  const auto found = std::find_if_not(moves.begin(), moves.end(), rule.sound);
  const std::size_t column = place_of(fields, rule.column);
  if (found == moves.end() || column == fields.size()) return;
  const std::int64_t at = found - moves.begin();
  fail(outcomes.column(column),
       fmt::format("trial {}, move {}", first_row + at / outcomes.width(), at % outcomes.width()),
       text_of(fields[column], *found), rule.expected);
}

/// Reads a column of whole numbers, in at most `numbered_blocks` blocks, which are spread evenly over it;
/// `expected` is what each must be, by its row.
template <class Expected>
void require_numbers(const hdf5::Dataset& dataset, std::int64_t rows, Expected expected) {
  const std::int64_t blocks = (rows + rows_at_once - 1) / rows_at_once;
  const std::int64_t read = std::min(blocks, numbered_blocks);
  std::vector<std::int64_t> numbers;
  for (std::int64_t i = 0; i < read; ++i) {
    const std::int64_t block = read == 1 ? 0 : i * (blocks - 1) / (read - 1);
    std::int64_t row = block * rows_at_once;
    numbers.resize(static_cast<std::size_t>(std::min(rows_at_once, rows - row)));
    dataset.read(row, std::ssize(numbers), numbers.data());
    for (const std::int64_t number : numbers) {
      if (number != expected(row))
        fail(dataset, fmt::format("row {}", row), fmt::format("{}", number),
             fmt::format("{}", expected(row)));
      ++row;
    }
  }
}

}  // namespace

void validate_numbering(const FileHeader& header, const TableIo& trials, const TableIo& jerks) {
  const RowRange rows = header.rows;
  const auto global = [&](std::int64_t row) { return rows.first + row; };
  require_numbers(trials.column(0), rows.count,
                  [&](std::int64_t row) { return global(row) / header.trials; });
  require_numbers(trials.column(1), rows.count,
                  [&](std::int64_t row) { return global(row) % header.trials; });
  std::int64_t last = rows.first;
  std::vector<std::int64_t> numbers;
  for (std::int64_t first = 0; first < jerks.rows(); first += rows_at_once) {
    numbers.resize(static_cast<std::size_t>(std::min(rows_at_once, jerks.rows() - first)));
    jerks.column(0).read(first, std::ssize(numbers), numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] < last || numbers[i] >= rows.end()) {
        fail(jerks.column(0), fmt::format("row {}", first + static_cast<std::int64_t>(i)),
             fmt::format("{}", numbers[i]), fmt::format("{} to {}, rising", last, rows.end() - 1));
      }
      last = numbers[i];
    }
  }
}

void validate_outcomes(const TableIo& outcomes, const std::vector<RecordField<MoveOutcome>>& fields,
                       std::int64_t first_row, std::span<const MoveOutcome> moves) {
  for (const ValueRule<M>& rule : measure_rules) require_sound(outcomes, fields, rule, first_row, moves);
  require_sound(outcomes, fields, arrival_rule, first_row, moves);
}

void validate_measure(const TableIo& outcomes, const std::vector<RecordField<MoveOutcome>>& fields,
                      std::string_view name, std::int64_t first_row, std::span<const MoveOutcome> moves) {
  for (const ValueRule<M>& rule : measure_rules) {
    if (rule.column == name) require_sound(outcomes, fields, rule, first_row, moves);
  }
}

void validate_jerks(const TableIo& table, std::int64_t moves, std::int64_t first,
                    std::span<const JerkRecord> jerks) {
  const std::vector<RecordField<J>>& fields = jerk_fields();
  const auto column = [&](std::string_view name) -> const hdf5::Dataset& {
    return table.column(place_of(fields, name));
  };
  for (std::size_t i = 0; i < jerks.size(); ++i) {
    const J& jerk = jerks[i];
    const auto row = [&] { return fmt::format("row {}", first + static_cast<std::int64_t>(i)); };
    if (jerk.move < 0 || jerk.move >= moves)
      fail(column("move"), row(), fmt::format("{}", jerk.move), fmt::format("0 to {}", moves - 1));
    for (const ValueRule<J>& rule : jerk_rules) {
      if (!rule.sound(jerk))
        fail(column(rule.column), row(), text_of(fields[place_of(fields, rule.column)], jerk), rule.expected);
    }
    if (i == 0 || jerks[i - 1].trial != jerk.trial) continue;
    const J& before = jerks[i - 1];
    if (std::tie(jerk.move, jerk.onset) < std::tie(before.move, before.onset))
      column("onset").fail(fmt::format("{}: it is before the jerk above it, of the same trial", row()));
  }
}

void validate_rigs(const FileHeader& header, const TableIo& counts, std::span<const std::int64_t> success,
                   std::span<const std::int64_t> trials) {
  const std::int64_t rigs = counts.width();
  if (counts.rows() != header.points || header.trials % rigs != 0) {
    counts.column(0).fail("its size differs from the points and rigs of the study");
  }
  const std::int64_t of_each = trials.empty() ? 0 : trials.front();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::int64_t point = static_cast<std::int64_t>(i) / rigs;
    if (trials[i] != of_each || (of_each != 0 && of_each != header.trials / rigs)) {
      counts.column(1).fail(fmt::format("row {}: {} trials of a rig; expected {}, or 0 of all", point,
                                        trials[i], header.trials / rigs));
    }
    if (success[i] < 0 || success[i] > trials[i]) {
      counts.column(0).fail(
          fmt::format("row {}: {} successes; expected 0 to {}", point, success[i], trials[i]));
    }
  }
}

}  // namespace zerocount

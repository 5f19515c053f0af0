#include "results/reading/validation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "results/layout/fields.hpp"

namespace zerocount {
namespace {

constexpr std::int64_t rows_at_once = chunk_elements;
constexpr std::int64_t numbered_blocks = 8;

bool is_valid(const ValidValues& valid, double value) {
  if (valid.expected.empty()) return true;
  return std::isnan(value) ? valid.nan : value >= valid.low && value <= valid.high;
}

/// The field of this name; null where there is none.
template <class Record>
const RecordField<Record>* find_field(const std::vector<RecordField<Record>>& fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [name](const auto& field) { return field.column.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

[[noreturn]] void fail(const hdf5::Dataset& dataset, const std::string& row, const std::string& value,
                       std::string_view expected) {
  dataset.fail(fmt::format("{}: it is {}; expected {}", row, value, expected));
}

/// Of a column of the outcomes: `holds` is what every move must fulfil.
template <class Holds>
void require_of_moves(const TableIo& outcomes, const std::vector<RecordField<MoveOutcome>>& fields,
                      const RecordField<MoveOutcome>& field, std::int64_t first_row,
                      std::span<const MoveOutcome> moves, std::string_view expected, const Holds& holds) {
  const auto found = std::find_if_not(moves.begin(), moves.end(), holds);
  if (found == moves.end()) return;
  const std::int64_t at = found - moves.begin();
  fail(outcomes.column(static_cast<std::size_t>(&field - fields.data())),
       fmt::format("trial {}, move {}", first_row + at / outcomes.width(), at % outcomes.width()),
       fmt::format("{}", value_of(field, *found)), expected);
}

void require_valid(const TableIo& outcomes, const std::vector<RecordField<MoveOutcome>>& fields,
                   const RecordField<MoveOutcome>& field, std::int64_t first_row,
                   std::span<const MoveOutcome> moves) {
  if (field.valid.expected.empty()) return;
  require_of_moves(outcomes, fields, field, first_row, moves, field.valid.expected,
                   [&](const MoveOutcome& move) { return is_valid(field.valid, value_of(field, move)); });
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
  for (const RecordField<MoveOutcome>& field : fields)
    require_valid(outcomes, fields, field, first_row, moves);
  require_of_moves(outcomes, fields, *find_field(fields, "arrived"), first_row, moves,
                   "1 exactly where there is a settling time",
                   [](const MoveOutcome& move) { return move.arrived != std::isnan(move.settling_time); });
}

void validate_measure(const TableIo& outcomes, const std::vector<RecordField<MoveOutcome>>& fields,
                      std::string_view name, std::int64_t first_row, std::span<const MoveOutcome> moves) {
  require_valid(outcomes, fields, *find_field(fields, name), first_row, moves);
}

void validate_jerks(const TableIo& table, std::int64_t moves, std::int64_t first,
                    std::span<const JerkRecord> jerks) {
  const std::vector<RecordField<JerkRecord>>& fields = jerk_fields();
  const auto column = [&](std::string_view name) -> const hdf5::Dataset& {
    return table.column(static_cast<std::size_t>(find_field(fields, name) - fields.data()));
  };
  for (std::size_t i = 0; i < jerks.size(); ++i) {
    const JerkRecord& jerk = jerks[i];
    const auto row = [&] { return fmt::format("row {}", first + static_cast<std::int64_t>(i)); };
    if (jerk.move < 0 || jerk.move >= moves)
      fail(column("move"), row(), fmt::format("{}", jerk.move), fmt::format("0 to {}", moves - 1));
    for (const RecordField<JerkRecord>& field : fields) {
      const double value = value_of(field, jerk);
      if (!is_valid(field.valid, value))
        fail(column(field.column.name), row(), fmt::format("{}", value), field.valid.expected);
    }
    if (i == 0 || jerks[i - 1].trial != jerk.trial) continue;
    const JerkRecord& before = jerks[i - 1];
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

#include "results/reading/validation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "results/layout/fields.hpp"
#include "results/reading/results_file.hpp"

namespace zerocount::reading {
namespace {

constexpr std::int64_t rows_at_once = layout::chunk_elements;
constexpr std::int64_t numbered_blocks = 8;

bool is_valid(const layout::ValidValues& valid, double value) {
  if (valid.expected.empty()) return true;
  return std::isnan(value) ? valid.nan : value >= valid.low && value <= valid.high;
}

/// Pointer to the description of the field with this name; null if there is none.
template <class Record>
const layout::RecordField<Record>* find_field(const std::vector<layout::RecordField<Record>>& fields,
                                              std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [name](const auto& field) { return field.column.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

[[noreturn]] void fail(const hdf5::RowSource& dataset, const std::string& row, const std::string& value,
                       std::string_view expected) {
  dataset.fail(fmt::format("{}: it is {}; expected {}", row, value, expected));
}

/// Checks that `holds` is true for the value of the field in every record.
/// @param row_of gives the row of the i-th record, for the message.
/// @param expected the possible values in words, for the message.
/// @throws Failure (bad_data) otherwise.
template <class Record, class RowOf, class Holds>
void require_all(const layout::TableReader& table, const std::vector<layout::RecordField<Record>>& fields,
                 const layout::RecordField<Record>& field, std::span<const Record> records,
                 const RowOf& row_of, std::string_view expected, const Holds& holds) {
  const auto found = std::find_if_not(records.begin(), records.end(), holds);
  if (found == records.end()) return;
  fail(table.column(static_cast<std::size_t>(&field - fields.data())), row_of(found - records.begin()),
       fmt::format("{}", layout::value_of(field, *found)), expected);
}

template <class Record, class RowOf>
void require_valid(const layout::TableReader& table, const std::vector<layout::RecordField<Record>>& fields,
                   const layout::RecordField<Record>& field, std::span<const Record> records,
                   const RowOf& row_of) {
  if (field.valid.expected.empty()) return;
  require_all(table, fields, field, records, row_of, field.valid.expected,
              [&](const Record& record) { return is_valid(field.valid, layout::value_of(field, record)); });
}

auto rows_of_moves(const layout::TableReader& outcomes, std::int64_t first_row) {
  return [first_row, moves = outcomes.width()](std::int64_t at) {
    return fmt::format("trial {}, move {}", first_row + at / moves, at % moves);
  };
}

/// Checks that a column of whole numbers has the value `expected(row)` in each row. If the column is long,
/// only `numbered_blocks` blocks are read, which are spread evenly over it.
template <class Expected>
void require_numbers(const hdf5::RowSource& dataset, std::int64_t rows, Expected expected) {
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

/// Checks that the global rows of kept trials rise within the rows of the file, and agree with design point
/// and index.
void require_kept_rows(const layout::FileHeader& header, const layout::TableReader& trials) {
  std::int64_t last = header.rows.first - 1;
  for (std::int64_t first = 0; first < trials.rows(); first += rows_at_once) {
    const std::int64_t count = std::min(rows_at_once, trials.rows() - first);
    std::vector<std::int64_t> rows(static_cast<std::size_t>(count)), points = rows, indices = rows;
    trials.row_scale().read(first, count, rows.data());
    trials.column(0).read(first, count, points.data());
    trials.column(1).read(first, count, indices.data());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool possible = rows[i] > last && rows[i] < header.rows.end() &&
                            points[i] == rows[i] / header.trials && indices[i] == rows[i] % header.trials;
      if (!possible) trials.row_scale().fail("its rows are not rising ones of the file's trials");
      last = rows[i];
    }
  }
}

}  // namespace

void validate_numbering(const layout::FileHeader& header, const layout::TableReader& trials,
                        const layout::TableReader& jerks) {
  const layout::RowRange rows = header.rows;
  const auto global = [&](std::int64_t row) { return rows.first + row; };
  if (layout::has_sums(header.retention)) {
    require_kept_rows(header, trials);
  } else {
    require_numbers(trials.column(0), rows.count,
                    [&](std::int64_t row) { return global(row) / header.trials; });
    require_numbers(trials.column(1), rows.count,
                    [&](std::int64_t row) { return global(row) % header.trials; });
  }
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

void validate_outcomes(const layout::TableReader& outcomes,
                       const std::vector<layout::RecordField<trial::MoveOutcome>>& fields,
                       std::int64_t first_row, std::span<const trial::MoveOutcome> moves) {
  const auto row_of = rows_of_moves(outcomes, first_row);
  for (const layout::RecordField<trial::MoveOutcome>& field : fields)
    require_valid(outcomes, fields, field, moves, row_of);
  require_all(outcomes, fields, *find_field(fields, "arrived"), moves, row_of,
              "1 exactly where there is a settling time",
              [](const trial::MoveOutcome& move) { return move.arrived != std::isnan(move.arrival_time); });
}

void validate_bands(const layout::TableReader& table, std::int64_t first_row,
                    std::span<const trial::BandOutcome> bands) {
  const auto row_of = [first_row, width = table.width()](std::int64_t at) {
    return fmt::format("trial {}, band {} of its moves", first_row + at / width, at % width);
  };
  for (const layout::RecordField<trial::BandOutcome>& field : layout::band_fields())
    require_valid(table, layout::band_fields(), field, bands, row_of);
}

void validate_tolerances(const layout::TableReader& table,
                         const std::vector<layout::RecordField<layout::ToleranceRecord>>& fields,
                         std::int64_t first_row, std::span<const layout::ToleranceRecord> records) {
  const auto row_of = [first_row, width = table.width()](std::int64_t at) {
    return fmt::format("trial {}, tolerance {} of its moves", first_row + at / width, at % width);
  };
  for (const layout::RecordField<layout::ToleranceRecord>& field : fields)
    require_valid(table, fields, field, records, row_of);
}

void validate_measure(const layout::TableReader& outcomes,
                      const std::vector<layout::RecordField<trial::MoveOutcome>>& fields,
                      std::string_view name, std::int64_t first_row,
                      std::span<const trial::MoveOutcome> moves) {
  require_valid(outcomes, fields, *find_field(fields, name), moves, rows_of_moves(outcomes, first_row));
}

void validate_jerks(const layout::TableReader& table, std::int64_t moves, std::int64_t first,
                    std::span<const layout::JerkRecord> jerks) {
  const std::vector<layout::RecordField<layout::JerkRecord>>& fields = layout::jerk_fields();
  const auto row_of = [first](std::int64_t at) { return fmt::format("row {}", first + at); };
  require_all(table, fields, *find_field(fields, "move"), jerks, row_of, fmt::format("0 to {}", moves - 1),
              [moves](const layout::JerkRecord& jerk) { return jerk.move >= 0 && jerk.move < moves; });
  for (const layout::RecordField<layout::JerkRecord>& field : fields)
    require_valid(table, fields, field, jerks, row_of);
  for (std::size_t i = 1; i < jerks.size(); ++i) {
    const layout::JerkRecord& before = jerks[i - 1];
    if (before.trial == jerks[i].trial &&
        std::tie(jerks[i].move, jerks[i].onset) < std::tie(before.move, before.onset)) {
      table.column(static_cast<std::size_t>(find_field(fields, "onset") - fields.data()))
          .fail(fmt::format("{}: it is before the jerk above it, of the same trial",
                            row_of(static_cast<std::int64_t>(i))));
    }
  }
}

void validate_jerk_counts(const layout::TableReader& table, std::span<const std::int64_t> rows,
                          std::span<const trial::MoveOutcome> outcomes,
                          std::span<const layout::JerkRecord> jerks) {
  const auto moves = std::ssize(outcomes) / std::ssize(rows);
  auto jerk = jerks.begin();
  for (std::int64_t i = 0; i < std::ssize(outcomes); ++i) {
    const std::int64_t row = rows[static_cast<std::size_t>(i / moves)];
    const std::int64_t count = outcomes[static_cast<std::size_t>(i)].jerk_count;
    for (const auto end = jerk + count; jerk != end; ++jerk) {
      if (jerk->trial == row && jerk->move == i % moves) continue;
      table.column(0).fail(
          fmt::format("it should have {} jerks of trial {}, move {}", count, row, i % moves));
    }
  }
}

void validate_groups(const layout::Grouping& grouping, const layout::FileHeader& header,
                     const layout::TableIo& counts, const StoredGroups& stored) {
  const std::int64_t groups = counts.width();
  const bool equal = grouping.has_equal_sizes;
  if (counts.rows() != header.points || (equal && header.trials % groups != 0))
    counts.column(0).fail("its size differs from the points and groups of the study");
  for (std::size_t i = 0; i < stored.trials.size(); ++i) {
    const std::int64_t group = static_cast<std::int64_t>(i) % groups;
    const std::int64_t most = (header.trials - group + groups - 1) / groups;
    const auto within = [](std::int64_t count, std::int64_t limit) { return count >= 0 && count <= limit; };
    const std::int64_t trials = stored.trials[i];
    const bool possible =
        equal ? trials == stored.trials.front() && (trials == 0 || trials == most) : within(trials, most);
    if (possible && within(stored.success[i], trials) &&
        (stored.goal_met.empty() || within(stored.goal_met[i], trials)))
      continue;
    counts.column(possible ? 0 : 1)
        .fail(fmt::format("row {}: impossible counts of {} {}; expected {} trials{}",
                          static_cast<std::int64_t>(i) / groups, grouping.name, group,
                          equal ? fmt::format("{}", most) : fmt::format("0 to {}", most),
                          equal ? ", or 0 of all" : ""));
  }
}

}  // namespace zerocount::reading

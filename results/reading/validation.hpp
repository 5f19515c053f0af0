#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "results/layout/groupings.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/table_io.hpp"

/// Checks that the values of a results file are in their ranges, whatever its study. A file whose checksum
/// trailer and checksums are right may still have been made by another program. Every function throws Failure
/// (bad_data) with the path, the dataset, the row and what was expected.
namespace zerocount::reading {

struct StoredGroups;

/// Requires consistent row numbers: point and index of a trial must agree with its row, and the trials of the
/// jerks must rise within the rows of the file. In a file that keeps failures, the rows of the trials rise
/// too. If more than 131072 trials are all kept, only eight blocks of 16384, spread evenly, are checked:
/// nothing is computed from these two columns, and reading them whole would take a tenth of the time of a
/// summary.
void validate_numbering(const layout::FileHeader& header, const layout::TableReader& trials,
                        const layout::TableReader& jerks);

/// Checks that the measures of `moves` have possible values.
/// @param first_row number of their first trial, for messages
/// @param fields descriptions of the columns of `outcomes`. Measures that the file does not have are not
/// checked.
void validate_outcomes(const layout::TableReader& outcomes,
                       const std::vector<layout::RecordField<trial::MoveOutcome>>& fields,
                       std::int64_t first_row, std::span<const trial::MoveOutcome> moves);

/// Checks that the measures of error bands have possible values.
/// @param first_row row of the first of `bands` in the table, for messages.
void validate_bands(const layout::TableReader& table, std::int64_t first_row,
                    std::span<const trial::BandOutcome> bands);

/// Checks that the settling times for tolerances have possible values.
/// @param first_row row of the first of `records` in the table, for messages.
void validate_tolerances(const layout::TableReader& table,
                         const std::vector<layout::RecordField<layout::ToleranceRecord>>& fields,
                         std::int64_t first_row, std::span<const layout::ToleranceRecord> records);

/// Checks that the measure `name` has possible values in `moves`; the other measures of `moves` are unknown.
/// @param first_row number of the first trial, for messages.
void validate_measure(const layout::TableReader& outcomes,
                      const std::vector<layout::RecordField<trial::MoveOutcome>>& fields,
                      std::string_view name, std::int64_t first_row,
                      std::span<const trial::MoveOutcome> moves);

/// Checks the rows of the table of jerks from `first` on, `jerks`, in a study whose trials have `moves`
/// moves. Within a trial the jerks must be in the order of their onsets, move by move.
void validate_jerks(const layout::TableReader& table, std::int64_t moves, std::int64_t first,
                    std::span<const layout::JerkRecord> jerks);

/// Checks that the trials' outcomes count exactly these jerks, in order of trials and moves.
/// @param rows global rows of the trials.
/// @param outcomes [trial][move].
/// @param jerks as many as `outcomes` count.
void validate_jerk_counts(const layout::TableReader& table, std::span<const std::int64_t> rows,
                          std::span<const trial::MoveOutcome> outcomes,
                          std::span<const layout::JerkRecord> jerks);

/// Checks the counts of trials in the groups of a grouping, such as machines. A group must not count more
/// trials than it has, and not more successes or met goals than trials. Machines must all count the same
/// number of trials: all that they have, or none.
void validate_groups(const layout::Grouping& grouping, const layout::FileHeader& header,
                     const layout::TableIo& counts, const StoredGroups& stored);

}  // namespace zerocount::reading

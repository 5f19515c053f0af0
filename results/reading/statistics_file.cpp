#include "results/reading/statistics_file.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/reading/trial_tables.hpp"
#include "results/reading/validation.hpp"

namespace zerocount::reading {
namespace {

template <class Number>
std::vector<Number> read_range(const layout::TableIo& io, std::int64_t first, std::int64_t end) {
  std::vector<Number> numbers(static_cast<std::size_t>(end - first));
  io.column(0).read(first, end - first, numbers.data());
  return numbers;
}

/// The rows must rise within those of the file, and be those of point and index.
void require_rows(const layout::TableIo& trials, const layout::FileHeader& header) {
  std::int64_t last = header.rows.first - 1;
  for (std::int64_t first = 0; first < trials.rows(); first += layout::chunk_elements) {
    const std::int64_t count = std::min(layout::chunk_elements, trials.rows() - first);
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

KeptTrials::KeptTrials(const hdf5::File& file, const layout::FileHeader& header)
    : inputs_(read_input_columns(file.open_group("trial"))),
      features_(read_features(file, layout::measure_table())),
      trials_(layout::TableIo::open(file, layout::trial_table(inputs_))),
      measures_(layout::outcome_fields(header.version, features_)),
      outcomes_(layout::TableIo::open(file, layout::outcome_table(header.version, features_))),
      jerks_(layout::TableIo::open(file, layout::jerk_table())) {
  if (outcomes_.rows() != trials_.rows())
    outcomes_.row_scale().fail("its size differs from that of the trials");
  require_rows(trials_, header);
}

std::vector<std::int64_t> KeptTrials::rows(std::int64_t first, std::int64_t count) const {
  std::vector<std::int64_t> rows(static_cast<std::size_t>(count));
  trials_.row_scale().read(first, count, rows.data());
  return rows;
}

layout::RowRange KeptTrials::positions_of(layout::RowRange rows) const {
  const std::int64_t first = first_not_below(trials_.row_scale(), trials_.rows(), rows.first);
  return {first, first_not_below(trials_.row_scale(), trials_.rows(), rows.end()) - first};
}

std::vector<double> KeptTrials::input(std::size_t column, std::int64_t first, std::int64_t count) const {
  std::vector<double> values(static_cast<std::size_t>(count));
  trials_.column(columns_before_inputs + column).read(first, count, values.data());
  return values;
}

std::vector<trial::MoveOutcome> KeptTrials::outcomes(std::int64_t first, std::int64_t count) const {
  std::vector<trial::MoveOutcome> moves = layout::read_records(outcomes_, measures_, first, count);
  validate_outcomes(outcomes_, measures_, first, moves);
  return moves;
}

std::vector<layout::JerkRecord> KeptTrials::jerks_at(std::int64_t first, std::int64_t count) const {
  std::vector<layout::JerkRecord> jerks = layout::read_records(jerks_, layout::jerk_fields(), first, count);
  validate_jerks(jerks_, moves(), first, jerks);
  return jerks;
}

std::vector<layout::JerkRecord> KeptTrials::jerks_of(layout::RowRange rows) const {
  const std::int64_t first = first_not_below(jerks_.column(0), jerks_.rows(), rows.first);
  const std::int64_t end = first_not_below(jerks_.column(0), jerks_.rows(), rows.end());
  return jerks_at(first, end - first);
}

void KeptTrials::require_valid_values() const {
  const std::int64_t at_once = layout::chunk_rows(moves());
  std::int64_t jerks = 0;
  for (std::int64_t first = 0; first < count(); first += at_once) {
    const std::int64_t block = std::min(at_once, count() - first);
    for (std::size_t column = 0; column < inputs_.size(); ++column) input(column, first, block);
    const std::vector<trial::MoveOutcome> outcomes_of_block = outcomes(first, block);
    const std::int64_t first_jerk = jerks;
    for (const trial::MoveOutcome& move : outcomes_of_block) {
      if (move.jerk_count > jerk_count() - jerks)
        jerks_.column(0).fail("it has fewer jerks than the outcomes count");
      jerks += move.jerk_count;
    }
    require_jerks_of(rows(first, block), outcomes_of_block, jerks_at(first_jerk, jerks - first_jerk));
  }
  if (jerks != jerk_count()) jerks_.column(0).fail("it has more jerks than the outcomes count");
}

/// Requires that the jerks are those that the outcomes count, in order of trials and moves.
void KeptTrials::require_jerks_of(std::span<const std::int64_t> rows,
                                  std::span<const trial::MoveOutcome> outcomes,
                                  std::span<const layout::JerkRecord> jerks) const {
  auto jerk = jerks.begin();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const std::int64_t row = rows[i / static_cast<std::size_t>(moves())];
    const std::int64_t move = static_cast<std::int64_t>(i) % moves();
    for (std::int64_t left = outcomes[i].jerk_count; left > 0; --left, ++jerk) {
      if (jerk->trial != row || jerk->move != move)
        jerks_.column(0).fail(
            fmt::format("it should have {} jerks of trial {}, move {}", outcomes[i].jerk_count, row, move));
    }
  }
}

StatisticsFile::StatisticsFile(const std::filesystem::path& path, Require require)
    : ResultsFile(path, require, layout::Contents::statistics),
      whole_(layout::TableIo::open(file(), layout::whole_sums_table())),
      real_(layout::TableIo::open(file(), layout::real_sums_table())) {
  if (header().kept == study::Kept::failures) failures_.emplace(file(), header());
  const layout::TableIo counts = layout::TableIo::open(file(), layout::sums_table());
  const std::int64_t points = (rows().end() - 1) / header().trials - first_point() + 1;
  if (counts.rows() != points)
    counts.row_scale().fail("it should have the design points of the file's trials");
  const std::vector<std::int64_t> whole = layout::read_column<std::int64_t>(counts, 0);
  const std::vector<std::int64_t> real = layout::read_column<std::int64_t>(counts, 1);
  Ends end{0, 0};
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole[i] < 0 || whole[i] > whole_.rows() - end.whole || real[i] < 0 ||
        real[i] > real_.rows() - end.real)
      counts.column(0).fail("its counts are not those of the numbers in the file");
    ends_.push_back(end = {end.whole + whole[i], end.real + real[i]});
  }
  if (end.whole != whole_.rows() || end.real != real_.rows())
    counts.column(0).fail("its counts are not those of the numbers in the file");
}

layout::RowRange StatisticsFile::rows_of(std::int64_t point) const {
  const std::int64_t first = std::max(rows().first, point * header().trials);
  return {first, std::min(rows().end(), (point + 1) * header().trials) - first};
}

layout::PointSums StatisticsFile::sums(std::int64_t index) const {
  if (file().text("sums_form") != layout::sums_form()) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: its sums are not in the form of this program; zerocount {}, which wrote them, "
                    "reads them, and 'zerocount export' has the statistics that it stored",
                    path().string(), header().provenance.zerocount_version));
  }
  const auto at = static_cast<std::size_t>(index);
  const Ends begin = at == 0 ? Ends{0, 0} : ends_[at - 1];
  return {read_range<std::int64_t>(whole_, begin.whole, ends_[at].whole),
          read_range<double>(real_, begin.real, ends_[at].real)};
}

}  // namespace zerocount::reading

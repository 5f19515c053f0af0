#include "results/reading/all_trials_file.hpp"

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/setting_study.hpp"

namespace zerocount::reading {

AllTrialsFile::AllTrialsFile(const std::filesystem::path& path, Require require,
                             const layout::MeasureTable* table, const study::Study* study)
    : ResultsFile(path, require, table, study) {
  layout::require_every_trial(path, header());
}

AllTrialsFile::AllTrialsFile(const AllTrialsFile& whole, std::int64_t setting) : ResultsFile(whole) {
  const study::Study& study = whole.study();
  if (study.settings.empty()) return;
  setting_ = {study::trial_indices(study), setting, study.trials};
  show_study(study::in_setting(study, setting));
}

AllTrialsFile AllTrialsFile::in_setting(std::int64_t setting) const {
  return {*this, setting};
}

std::int64_t AllTrialsFile::row_in_file(std::int64_t row) const {
  if (!setting_) return row;
  const std::int64_t draws = header().trials;
  const std::int64_t point = row / draws;
  if (row % draws == 0 && row > 0 && row == rows().end()) return point * setting_->trials;  // the end
  return point * setting_->trials + setting_->indices.trial_of(row % draws, setting_->number);
}

/// Checks that the file holds the trials in `range`.
/// @throws Failure (bad_data) otherwise.
void AllTrialsFile::require_rows(layout::RowRange range) const {
  if (range.first >= rows().first && range.count >= 0 && range.end() <= rows().end()) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: trials {} to {} were asked for; it holds {} to {}", path().string(),
                            range.first, range.end() - 1, rows().first, rows().end() - 1));
}

layout::RowRange AllTrialsFile::local(layout::RowRange range) const {
  require_rows(range);
  if (!setting_ || range.count == 0) return trials()->positions_of({row_in_file(range.first), range.count});
  const std::int64_t first = row_in_file(range.first);
  return trials()->positions_of({first, row_in_file(range.end() - 1) + 1 - first});
}

template <class Value>
std::vector<Value> AllTrialsFile::chosen(layout::RowRange range, std::vector<Value> read,
                                         std::int64_t width) const {
  if (!setting_ || range.count == 0) return read;
  const std::int64_t first = row_in_file(range.first);
  std::vector<Value> values;
  values.reserve(static_cast<std::size_t>(range.count * width));
  for (std::int64_t row = range.first; row < range.end(); ++row) {
    const auto trial = read.begin() + (row_in_file(row) - first) * width;
    values.insert(values.end(), trial, trial + width);
  }
  return values;
}

std::vector<double> AllTrialsFile::input(std::size_t column, layout::RowRange range) const {
  return chosen(range, trials()->input(column, local(range)), 1);
}

std::vector<trial::MoveOutcome> AllTrialsFile::outcomes(layout::RowRange range) const {
  return chosen(range, trials()->outcomes(local(range)), moves());
}

StoredOutcomes AllTrialsFile::stored_outcomes(layout::RowRange range) const {
  return trials()->stored_outcomes(local(range));
}

std::vector<trial::MoveOutcome> AllTrialsFile::outcomes(const OutcomeColumns& columns,
                                                        layout::RowRange range) const {
  return chosen(range, trials()->outcomes(columns, local(range)), moves());
}

std::vector<std::int64_t> AllTrialsFile::jerk_counts(const OutcomeColumns& columns,
                                                     layout::RowRange range) const {
  return chosen(range, trials()->jerk_counts(columns, local(range)), 1);
}

std::vector<double> AllTrialsFile::measure(std::string_view name, layout::RowRange range) const {
  return chosen(range, trials()->measure(name, local(range)), moves());
}

std::vector<layout::JerkRecord> AllTrialsFile::jerks_at(std::int64_t first, std::int64_t count) const {
  std::vector<layout::JerkRecord> found = trials()->jerks_at(first, count);
  if (!setting_) return found;
  const OneSetting& one = *setting_;
  std::erase_if(found, [&](const layout::JerkRecord& jerk) {
    return one.indices.setting_of(jerk.trial % one.trials) != one.number;
  });
  for (layout::JerkRecord& jerk : found) {
    const std::int64_t point = jerk.trial / one.trials;
    jerk.trial = point * header().trials + one.indices.draw_of(jerk.trial % one.trials);
  }
  return found;
}

std::vector<layout::JerkRecord> AllTrialsFile::jerks(layout::RowRange range) const {
  require_rows(range);
  const std::int64_t first = first_jerk_from(range.first);
  return jerks_at(first, first_jerk_from(range.end()) - first);
}

}  // namespace zerocount::reading

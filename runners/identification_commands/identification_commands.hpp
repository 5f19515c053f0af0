#pragma once

#include <optional>
#include <vector>

#include "analysis/records/raw_series.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"

namespace zerocount::identification_commands {

/// The options that say what the columns of a record are, `--column`, `--separator`, `--sample-time`, and
/// which times are masked, `--exclude`.
std::vector<command_line::OptionSpec> column_options();

/// Sets the choices of these options. Refuses those that contradict each other, or the other choices.
void set_columns(const command_line::Arguments& arguments, records::SeriesChoice& choice);

/// Masks the intervals of `--exclude` in all series. Refuses an interval without a sample of any of them.
void exclude_times(const command_line::Arguments& arguments, std::vector<records::RawSeries>& series);

/// The delay of the torque by `--delay`, samples.
std::optional<double> delay_option(const command_line::Arguments& arguments);

/// The series of all files, as the options say, without what `--exclude` masks. Refuses options without
/// effect.
std::vector<records::RawSeries> read_all_series(const command_line::Arguments& arguments);

commands::Command experiment_command();
commands::Command identify_command();

}  // namespace zerocount::identification_commands

#pragma once

#include <optional>
#include <vector>

#include "analysis/record/records/raw_series.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"

namespace zerocount::identification_commands {

/// Options that describe the columns of a measured record (`--column`, `--separator`, `--sample-time`) and
/// its masked times (`--exclude`).
std::vector<command_line::OptionSpec> column_options();

/// Reads the options of column_options(), and stores them in `choice`. Refuses options that contradict each
/// other or the other choices.
void set_columns(const command_line::Arguments& arguments, records::SeriesChoice& choice);

/// Masks, in all measured series, the samples within the time intervals of the option `--exclude`. Refuses an
/// interval that contains no sample of any series.
void exclude_times(const command_line::Arguments& arguments, std::vector<records::RawSeries>& series);

/// Delay of the torque against the measured position, from the option `--delay`, samples; nothing without the
/// option.
std::optional<double> delay_option(const command_line::Arguments& arguments);

/// Measured series of all files that the operands name, read as the options say, with the intervals of
/// `--exclude` masked. Refuses options without effect.
std::vector<records::RawSeries> read_all_series(const command_line::Arguments& arguments);

commands::Command experiment_command();
commands::Command identify_command();

}  // namespace zerocount::identification_commands

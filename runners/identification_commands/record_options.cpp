#include "runners/identification_commands/record_options.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "analysis/records/dataset_file.hpp"
#include "analysis/records/text_table.hpp"
#include "core/failure/failure.hpp"
#include "core/text/number_text.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/hdf5/array_file.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::identification_commands {
namespace {

/// MAT files of versions 5 to 7 begin with a text.
bool is_old_mat_file(const std::string& path) {
  constexpr std::string_view beginning = "MATLAB 5.0 MAT-file";
  return storage::bytes_at(path, 0, beginning.size()) == beginning;
}

}  // namespace

std::vector<command_line::OptionSpec> column_options() {
  return {{"column", "QUANTITY=COLUMN",
           "column of a quantity, with its unit and factors: time=t[ms], torque=current[A]*0.87; may be "
           "repeated",
           true},
          {"separator", "NAME", "separator of the cells: comma, semicolon, tab or blanks (default: detected)",
           false, 1, records::separator_names()},
          {"sample-time", "T", "sample time of a record without a column for the time, s"},
          {"exclude", "FROM:TO", "times to leave out, s; may be repeated", true}};
}

void set_columns(const command_line::Arguments& arguments, records::SeriesChoice& choice) {
  for (const std::string& text : arguments.values("column")) {
    const records::ParsedMapping parsed = records::parse_mapping(text);
    if (!parsed.fault.empty()) arguments.refuse("option '--column': " + parsed.fault);
    choice.columns.push_back(parsed.mapping);
  }
  if (arguments.has("separator")) {
    const std::vector<std::string> names = records::separator_names();
    const auto found = std::find(names.begin(), names.end(), arguments.choice("separator"));
    choice.separator = static_cast<records::Separator>(found - names.begin());
  }
  if (const std::optional<std::string> text = arguments.value("sample-time")) {
    choice.sample_time = text::parse_number<double>(*text);
    if (!choice.sample_time || !std::isfinite(*choice.sample_time) || *choice.sample_time <= 0.0) {
      arguments.refuse(fmt::format("option '--sample-time': '{}' is not a positive number", *text));
    }
  }
  if (const std::string reason = records::contradiction_in(choice); !reason.empty()) arguments.refuse(reason);
}

std::vector<records::ExcludedTime> excluded_times(const command_line::Arguments& arguments) {
  std::vector<records::ExcludedTime> times;
  for (const std::string& text : arguments.values("exclude")) {
    const std::size_t colon = text.find(':');
    const auto from = text::parse_number<double>(std::string_view(text).substr(0, colon));
    const auto to = colon == std::string::npos
                        ? std::nullopt
                        : text::parse_number<double>(std::string_view(text).substr(colon + 1));
    if (!from || !to || !std::isfinite(*from) || !std::isfinite(*to) || *from > *to) {
      arguments.refuse(fmt::format("option '--exclude': '{}' is not FROM:TO, such as 1.2:3.4 (s)", text));
    }
    times.push_back({*from, *to});
  }
  return times;
}

void exclude_times(const command_line::Arguments& arguments, std::vector<records::RawSeries>& series) {
  for (const records::ExcludedTime& times : excluded_times(arguments)) {
    bool any = false;
    for (records::RawSeries& one : series) any = exclude(one, times) || any;
    if (any) continue;
    arguments.refuse(fmt::format("option '--exclude': no record has a sample between {:g} and {:g} s",
                                 times.from, times.to));
  }
}

RecordFile record_file(const std::string& path, const records::SeriesChoice& choice) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  if (extension != ".h5" && yaml::is_stream(path)) return RecordFile::table;
  const bool is_hdf5 = hdf5::is_hdf5_with_user_block(path);
  if (!is_hdf5 && is_old_mat_file(path)) {
    throw Failure(ExitCode::bad_input,
                  path + ": a MAT file before version 7.3; expected version 7.3: save('-v7.3', …)");
  }
  if (!is_hdf5 && extension != ".h5") return RecordFile::table;
  return choice.columns.empty() ? RecordFile::results : RecordFile::datasets;
}

std::vector<records::RawSeries> read_series(const std::string& path, const records::SeriesChoice& choice) {
  if (record_file(path, choice) == RecordFile::datasets) {
    return records::read_columns(records::DatasetFile(path), choice);
  }
  return records::read_columns(records::TextTable(path, choice.separator), choice);
}

}  // namespace zerocount::identification_commands

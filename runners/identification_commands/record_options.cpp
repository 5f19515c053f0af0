#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/record/records/dataset_file.hpp"
#include "analysis/record/records/equal_series.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "experiments/tables/text_table.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/hdf5/foreign_file.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/storage/file_contents.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/identification_commands/identification_commands.hpp"
#include "runners/status/status.hpp"

namespace zerocount::identification_commands {
namespace {

/// Kind of a file with measured records: a text table, an HDF5 file of datasets, or a results file of this
/// program.
enum class RecordFile { table, datasets, results };

/// Determines the kind of a file, from its signature or from its name (the signature may be damaged). An HDF5
/// file is a file of datasets if columns are chosen, and a results file otherwise.
RecordFile record_file(const std::string& path, const records::SeriesChoice& choice) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  if (extension != ".h5" && yaml::is_stream(path)) return RecordFile::table;
  const bool is_hdf5 = hdf5::is_hdf5_with_user_block(path);
  if (!is_hdf5 && records::is_mat_file(path)) return RecordFile::datasets;
  if (!is_hdf5 && extension != ".h5") return RecordFile::table;
  return choice.columns.empty() ? RecordFile::results : RecordFile::datasets;
}

/// Time intervals that the option `--exclude` masks in the records. Refuses any value but "FROM:TO".
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

std::optional<std::string> column_option(const command_line::Arguments& arguments, const char* name,
                                         const std::vector<std::string>& columns) {
  if (!arguments.has(name)) return std::nullopt;
  return arguments.one_of(name, columns);
}

/// Bandwidth of the amplifier from the option, Hz; 0: ideal amplifier; nothing without the option. A positive
/// value below 0.01 Hz is refused, because it is implausible for a positioning drive and not identifiable
/// from the samples.
std::optional<double> bandwidth_option(const command_line::Arguments& arguments) {
  constexpr double least = 0.01;
  const std::optional<double> bandwidth = command_line::number_option(arguments, "amplifier-bandwidth", 0.0);
  if (bandwidth && *bandwidth > 0.0 && *bandwidth < least) {
    arguments.refuse(fmt::format(
        "option '--amplifier-bandwidth': {:g} Hz; expected 0 (ideal amplifier), or {} Hz at least",
        *bandwidth, least));
  }
  return bandwidth;
}

/// Size of an encoder count, rad or m, from the option for the kind of axis (--counts-per-revolution or
/// --resolution); nothing without both. Refuses both together.
std::optional<double> count_size_option(const command_line::Arguments& arguments,
                                        const records::SeriesChoice& choice) {
  const auto counts = command_line::number_option(arguments, "counts-per-revolution", 1.0);
  const auto resolution =
      command_line::number_option(arguments, "resolution", std::numeric_limits<double>::min());
  if (counts && resolution) {
    arguments.refuse("options '--counts-per-revolution' and '--resolution' exclude each other");
  }
  if (counts && choice.linear) {
    arguments.refuse(
        "option '--counts-per-revolution' applies only to a rotary axis; expected '--resolution'");
  }
  return counts ? std::optional(2.0 * std::numbers::pi / *counts) : resolution;
}

records::SeriesChoice series_choice(const command_line::Arguments& arguments) {
  constexpr double any = -std::numeric_limits<double>::infinity();
  records::SeriesChoice choice;
  choice.torque = column_option(arguments, "torque", {"torque", "drive_torque", "force", "drive_force"});
  choice.angle = column_option(arguments, "angle", {"count", "theta", "position"});
  choice.bandwidth = bandwidth_option(arguments);
  choice.delay = delay_option(arguments);
  choice.dac_bits = arguments.whole_number("dac-bits", 2, 32);
  choice.preload = command_line::number_option(arguments, "preload", any);
  choice.hardening = command_line::number_option(arguments, "hardening", 0.0);
  set_columns(arguments, choice);
  choice.linear =
      arguments.choice("axis") == "linear" ||
      std::any_of(choice.columns.begin(), choice.columns.end(),
                  [](const records::ColumnMapping& one) { return records::is_linear(one.quantity); });
  if (arguments.has("axis") && arguments.choice("axis") == "rotary" && choice.linear)
    arguments.refuse("'--axis rotary' has a torque and an angle, '--column' gives a force or a position");
  choice.rotary = (arguments.has("axis") && !choice.linear) || arguments.has("counts-per-revolution");
  choice.count_size = count_size_option(arguments, choice);
  return choice;
}

/// Indices of the design points whose records are read from a results file: those of the option --point, or
/// all that keep the trace of the trial and are of one axis.
/// @param index number of the trial
std::vector<std::int64_t> points_of(const command_line::Arguments& arguments, const std::string& path,
                                    std::int64_t index) {
  if (arguments.has("point")) {
    return command_line::point_options(arguments, reading::AllTrialsFile(path).point_labels());
  }
  const records::TracedPoints traced = records::traced_points(path, index);
  if (!traced.left_out.empty()) {
    status::tell("zerocount identify: {}: left out, because plant or friction has other values there: {}\n",
                 path, fmt::join(traced.left_out, ", "));
  }
  return traced.points;
}

/// Refuses options that none of the given kinds of files uses, such as --separator without a text table.
void refuse_options_without_file(const command_line::Arguments& arguments,
                                 const std::vector<RecordFile>& files) {
  const auto any = [&](RecordFile kind) { return std::ranges::find(files, kind) != files.end(); };
  const auto require = [&](bool there, std::initializer_list<const char*> options, const char* what) {
    for (const char* option : options) {
      if (!there && arguments.has(option))
        arguments.refuse(fmt::format("option '--{}' needs {}", option, what));
    }
  };
  require(any(RecordFile::results), {"point", "trial"}, "a results file");
  require(any(RecordFile::table), {"separator"}, "a text table");
  require(any(RecordFile::table) || any(RecordFile::datasets), {"sample-time", "axis", "any-magnitude"},
          "a table; a results file says this itself");
}

/// A measured series, and the index of the operand (file) from which it was read.
struct FileSeries {
  std::size_t operand;
  records::RawSeries series;
};

/// Refuses two files with equal readings. They would count as independent, which makes the confidence
/// intervals too narrow.
void refuse_equal_files(const command_line::Arguments& arguments, const std::vector<FileSeries>& found) {
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (found[i].operand != found[j].operand && records::are_equal(found[i].series, found[j].series))
        arguments.refuse(fmt::format(
            "{} and {} have the same readings, which would count twice; expected each record once, or "
            "--allow-equal if they come from two tests",
            found[j].series.name, found[i].series.name));
}

/// Refuses options that have no effect on any of the records that were read, such as the resolution of an
/// encoder without a column in counts.
void refuse_options_without_effect(const command_line::Arguments& arguments,
                                   const std::vector<records::RawSeries>& series) {
  const auto counted = [](const records::RawSeries& one) { return one.count_size > 0.0; };
  if (std::ranges::none_of(series, counted)) {
    for (const char* option : {"counts-per-revolution", "resolution"}) {
      if (!arguments.has(option)) continue;
      arguments.refuse(fmt::format(
          "option '--{}' has no effect, because the {} is not in counts; expected a column count, or "
          "--column '{}=COLUMN[count]'",
          option, series.front().linear ? "position" : "angle",
          series.front().linear ? "position" : "angle"));
    }
  }
  const auto coded = [](const records::RawSeries& one) { return !one.code.empty(); };
  if (arguments.has("dac-bits") && std::ranges::none_of(series, coded))
    arguments.refuse("option '--dac-bits' has no effect without a column code");
}

}  // namespace

std::optional<double> delay_option(const command_line::Arguments& arguments) {
  constexpr double most = 1e6;
  const std::optional<double> delay = command_line::number_option(arguments, "delay", 0.0);
  if (delay && *delay > most)
    arguments.refuse(fmt::format("option '--delay': {:g} samples; expected up to {:g}", *delay, most));
  return delay;
}

std::vector<command_line::OptionSpec> column_options() {
  return {
      {"column", "QUANTITY=COLUMN",
       "column of a quantity, with its unit and factors: time=t[ms], torque=current[A]*0.87; may be repeated",
       true},
      {"separator", "NAME", "separator of the cells: comma, semicolon, tab or blanks (default: detected)",
       false, 1, tables::separator_names()},
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
    const std::vector<std::string> names = tables::separator_names();
    const auto found = std::find(names.begin(), names.end(), arguments.choice("separator"));
    choice.separator = static_cast<tables::Separator>(found - names.begin());
  }
  if (const std::optional<std::string> text = arguments.value("sample-time")) {
    choice.sample_time = text::parse_number<double>(*text);
    if (!choice.sample_time || !std::isfinite(*choice.sample_time) || *choice.sample_time <= 0.0) {
      arguments.refuse(fmt::format("option '--sample-time': '{}' is not a positive number", *text));
    }
  }
  if (const std::string reason = records::contradiction_in(choice); !reason.empty()) arguments.refuse(reason);
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

std::vector<records::RawSeries> read_all_series(const command_line::Arguments& arguments) {
  const records::SeriesChoice choice = series_choice(arguments);
  const std::vector<std::string>& paths = arguments.operands();
  std::vector<RecordFile> files;
  files.reserve(paths.size());
  for (const std::string& path : paths) files.push_back(record_file(path, choice));
  refuse_options_without_file(arguments, files);
  std::vector<FileSeries> of_files;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string& path = paths[i];
    if (files[i] != RecordFile::results) {
      for (records::RawSeries& series :
           files[i] == RecordFile::datasets
               ? records::read_columns(records::DatasetFile(path), choice)
               : records::read_columns(tables::TextTable(path, choice.separator), choice))
        of_files.push_back({i, std::move(series)});
      continue;
    }
    constexpr std::int64_t most = std::int64_t{1} << 53;
    const std::int64_t index = arguments.whole_number("trial", 0, most).value_or(0);
    for (const std::int64_t point : points_of(arguments, path, index)) {
      of_files.push_back({i, records::read_study_series(path, point, index, choice)});
    }
  }
  if (!arguments.has("allow-equal")) refuse_equal_files(arguments, of_files);
  std::vector<records::RawSeries> found;
  for (FileSeries& one : of_files) found.push_back(std::move(one.series));
  for (const records::RawSeries& series : found) {
    for (const std::string& note : series.notes)
      status::tell("zerocount identify: {}: {}\n", series.name, note);
  }
  refuse_options_without_effect(arguments, found);
  exclude_times(arguments, found);
  return found;
}

}  // namespace zerocount::identification_commands

// Feeds a record for `zerocount identify`: options, one a line, such as "--column time=t[ms]"; an empty line;
// the table. Reads it to where the search for parameters would begin.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/record/fit/records/checked_record.hpp"
#include "analysis/record/sliding_identification/sliding_record.hpp"
#include "experiments/tables/text_table.hpp"
#include "runners/identification_commands/identification_commands.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace {

using namespace zerocount;

/// Words of the command line: of each line the option, and the rest as its value.
std::vector<std::string> split_words(std::string_view lines) {
  std::vector<std::string> words;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    const std::size_t blank = line.find(' ');
    words.emplace_back(line.substr(0, blank));
    if (blank != std::string_view::npos) words.emplace_back(line.substr(blank + 1));
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
  return words;
}

void read_record(const std::filesystem::path& path, const std::vector<std::string>& words) {
  std::vector<command_line::OptionSpec> options = identification_commands::column_options();
  options.push_back({"help,h", "", ""});
  const command_line::Arguments arguments(
      {.name = "identify", .operands = "", .options = options, .min_operands = 0, .max_operands = 0}, words);
  records::SeriesChoice choice{.count_size = 0.00628};
  identification_commands::set_columns(arguments, choice);
  const tables::TextTable table(path, choice.separator);
  fuzz::require_text(table.columns_text());
  std::vector<records::RawSeries> found = records::read_columns(table, choice);
  identification_commands::exclude_times(arguments, found);
  for (const records::RawSeries& series : found) {
    fuzz::require_clear_refusal([&] { fit::checked_record(series, true); });
    fuzz::require_clear_refusal([&] { fit::checked_record(series, false); });
    fuzz::require_clear_refusal([&] { sliding_identification::sliding_record(series); });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::MemoryFile file;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t options = input.starts_with("--") ? input.find("\n\n") : 0;
  if (options == std::string_view::npos) return 0;
  file.replace(options == 0 ? input : input.substr(options + 2));
  fuzz::require_clear_refusal([&] { read_record(file.path(), split_words(input.substr(0, options))); });
  return 0;
}

// The table that command.torque.file names.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/text/number_text.hpp"
#include "core/text/trimmed.hpp"
#include "core/text/unit.hpp"
#include "experiments/sections/torque_record.hpp"

namespace zerocount::sections {
namespace {

constexpr std::string_view torque_path = "command.torque.file";
constexpr std::string_view blank_characters = " \t\r\"";

std::string_view stripped(std::string_view text) {
  return text::trimmed(text, blank_characters);
}

/// The lines of a table with their numbers from 1.
struct TableLine {
  std::string_view text;
  int number;
};

std::vector<TableLine> lines_of(std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  std::vector<TableLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = stripped(text.substr(0, end));
    if (!line.empty() && line.front() != '#') lines.push_back({text.substr(0, end), number});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string_view> cells_in(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = std::min(line.find(separator), line.size());
    cells.push_back(stripped(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

/// The name that a column may have, and the unit of its numbers.
struct WantedColumn {
  std::vector<std::string_view> names;
  text::Dimension dimension;
  std::string_view expected;
};

struct FoundTableColumn {
  std::size_t index;
  double si;  ///< one of its unit in SI units
};

/// Reads a table line by line; reports what is wrong, and then has no rows.
class TorqueTable {
 public:
  TorqueTable(const std::string& text, std::string_view source, bool linear, yaml::Problems& problems)
      : source_(source), linear_(linear), problems_(problems) {
    const std::vector<TableLine> lines = lines_of(text);
    if (lines.size() < 3 || lines.size() > max_record_rows + 1) {
      fail(1, fmt::format("the table has {} rows", lines.empty() ? 0 : lines.size() - 1),
           fmt::format("a header such as {}, and 2 to {} rows of numbers", header(), max_record_rows));
      return;
    }
    for (const char separator : {'\t', ';', ','}) {
      if (lines[0].text.find(separator) == std::string_view::npos) continue;
      separator_ = separator;
      break;
    }
    const auto time = column(lines[0], {{"t", "time"}, text::Dimension::time, "s, ms or us"});
    const auto torque = time ? torque_column(lines[0]) : std::nullopt;
    if (!torque) return;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (add(lines[i], *time, *torque)) continue;
      rows_.clear();
      return;
    }
  }

  /// [row] time (s, from 0 on) and torque (N m or N).
  const std::vector<std::pair<double, double>>& rows() const { return rows_; }

 private:
  std::string_view header() const { return linear_ ? "t [s], force [N]" : "t [s], torque [N m]"; }

  bool fail(int line, const std::string& what, const std::string& expected) {
    problems_.add({source_, line, 1}, torque_path, what, expected);
    return false;
  }

  std::optional<FoundTableColumn> torque_column(const TableLine& line) {
    if (!linear_) return column(line, {{"torque", "drive_torque"}, text::Dimension::torque, "N m or mN m"});
    return column(line, {{"force", "drive_force", "torque"}, text::Dimension::force, "N, mN or kN"});
  }

  std::optional<FoundTableColumn> column(const TableLine& line, const WantedColumn& wanted) {
    const std::vector<std::string_view> cells = cells_in(line.text, separator_);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::size_t open = std::min(cells[i].find('['), cells[i].size());
      const std::string_view name = stripped(cells[i].substr(0, open));
      if (std::ranges::find(wanted.names, name) == wanted.names.end()) continue;
      if (open == cells[i].size()) return FoundTableColumn{i, 1.0};
      const std::string_view unit = cells[i].substr(open + 1, cells[i].find(']', open) - open - 1);
      const auto known = text::unit_named(unit);
      if (known && known->dimension == wanted.dimension) return FoundTableColumn{i, known->si};
      fail(line.number, fmt::format("the column {} has the unit '{}'", name, unit),
           std::string(wanted.expected));
      return std::nullopt;
    }
    fail(line.number, fmt::format("the table has no column {}", wanted.names.front()),
         fmt::format("a header such as {}", header()));
    return std::nullopt;
  }

  bool add(const TableLine& line, const FoundTableColumn& time, const FoundTableColumn& torque) {
    const std::vector<std::string_view> cells = cells_in(line.text, separator_);
    std::vector<double> found;
    for (const FoundTableColumn& column : {time, torque}) {
      const auto number =
          column.index < cells.size() ? text::parse_number<double>(cells[column.index]) : std::nullopt;
      if (!number || !std::isfinite(*number)) {
        return fail(line.number,
                    column.index < cells.size() ? fmt::format("'{}' is not a number", cells[column.index])
                                                : fmt::format("the row has {} cells", cells.size()),
                    "a finite number for the time and for the torque");
      }
      found.push_back(*number * column.si);
    }
    if (rows_.empty()) first_ = found[0];
    const double now = found[0] - first_;
    if (!rows_.empty() && !(now > rows_.back().first)) {
      return fail(line.number,
                  fmt::format("the time {:.9g} s is not after the one before it, {:.9g} s", found[0],
                              rows_.back().first + first_),
                  "increasing times");
    }
    rows_.emplace_back(now, found[1]);
    return true;
  }

  std::string_view source_;
  bool linear_;
  yaml::Problems& problems_;
  char separator_{','};
  double first_{0.0};  ///< time of the first row, s
  std::vector<std::pair<double, double>> rows_;
};

bool is_linear_axis(const yaml::YamlNode& root) {
  const auto axis = yaml::find_field({&root, ""}, "axis");
  return axis && axis->node->kind == yaml::YamlNode::Kind::scalar && axis->node->text == "linear";
}

}  // namespace

std::vector<std::string> torque_record_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                                 yaml::Problems& problems) {
  const auto command = yaml::find_field({&root, ""}, "command");
  const auto torque = command ? yaml::find_field(*command, "torque") : std::nullopt;
  const auto file = torque ? yaml::find_field(*torque, "file") : std::nullopt;
  if (!file || file->node->kind != yaml::YamlNode::Kind::scalar) return {};
  const auto name = yaml::read_line(*file, problems);
  if (!name) return {};
  if (!read) {
    problems.add(*file, "this command does not read files of torques", "a list of pairs");
    return {};
  }
  const TorqueTable table(read(*name, "a table of torques"), file->node->text, is_linear_axis(root),
                          problems);
  if (table.rows().empty()) return {};
  std::string list = fmt::format("{}=[", torque_path);
  for (const auto& [time, value] : table.rows()) {
    if (list.back() != '[') list += ", ";
    list += fmt::format("[{}, {}]", time, value);
  }
  std::vector<std::string> overrides{list + "]"};
  if (!yaml::find_field(*command, "hold")) {
    const double last = table.rows().back().first;
    overrides.push_back(
        fmt::format("command.hold={}", 2.0 * last - table.rows()[table.rows().size() - 2].first));
  }
  return overrides;
}

}  // namespace zerocount::sections

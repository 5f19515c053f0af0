#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "experiments/sections/spectrum.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::sections {
namespace {

constexpr const char* table_form = "a line 'frequency in Hz, density' for each point, such as 10, 1e-9";

/// The numbers of a line; empty if it has anything but two.
std::optional<std::array<double, 2>> numbers_of(const std::string& line) {
  constexpr const char* blanks = " \t\r";
  const char* rest = line.c_str();
  const char* const end = rest + line.size();
  std::array<double, 2> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    rest += std::strspn(rest, blanks);
    if (*rest == '+') ++rest;
    const auto [stop, error] = std::from_chars(rest, end, values[i]);
    if (error != std::errc{}) return std::nullopt;
    rest = stop + std::strspn(stop, blanks);
    if (i == 0 && (*rest == ',' || *rest == ';')) ++rest;
  }
  return rest == end ? std::optional(values) : std::nullopt;
}

/// The table as a list of pairs in YAML. Reports a line that is none of it, and returns nothing.
std::optional<std::string> list_of(const std::string& text, const std::string& source,
                                   const std::string& path, yaml::Problems& problems) {
  std::istringstream lines(text);
  std::string list;
  bool named = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r\xEF\xBB\xBF");
    if (first == std::string::npos || line[first] == '#') continue;
    if (const auto point = numbers_of(line.substr(first))) {
      list += fmt::format("{}[{}, {}]", list.empty() ? "" : ", ", (*point)[0], (*point)[1]);
    } else if (!list.empty() || named || std::strchr("+-.0123456789", line[first]) != nullptr) {
      problems.add({source, number, 1}, path, "this is not a point of a spectrum", table_form);
      return std::nullopt;
    }
    named = true;
  }
  if (list.empty()) {
    problems.add({source, 1, 1}, path, "the table has no points", table_form);
    return std::nullopt;
  }
  return "[" + list + "]";
}

void add_spectra_below(const yaml::Field& disturbance, const SamplesReader& read, yaml::Problems& problems,
                       std::vector<std::string>& overrides) {
  const auto list = yaml::find_field(disturbance, "vibration");
  if (!list || list->node->kind != yaml::YamlNode::Kind::list) return;
  for (std::size_t i = 0; i < list->node->items.size(); ++i) {
    const auto spectrum = yaml::find_field(yaml::item_of(*list, i), "spectrum");
    if (!spectrum || spectrum->node->kind != yaml::YamlNode::Kind::scalar) continue;
    const auto file = yaml::read_line(*spectrum, problems);
    if (!file) continue;
    if (!read) {
      problems.add(*spectrum, "this command does not read files of spectra", "a list of pairs");
      continue;
    }
    if (const auto table =
            list_of(read(*file, "a table of a spectrum"), spectrum->node->text, spectrum->path, problems))
      overrides.push_back(spectrum->path + "=" + *table);
  }
}

}  // namespace

std::vector<std::string> spectrum_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                            yaml::Problems& problems) {
  std::vector<std::string> overrides;
  const auto disturbance = yaml::find_field({&root, ""}, "disturbance");
  if (!disturbance) return overrides;
  add_spectra_below(*disturbance, read, problems, overrides);
  if (const auto load = yaml::find_field(*disturbance, "load"))
    add_spectra_below(*load, read, problems, overrides);
  return overrides;
}

}  // namespace zerocount::sections

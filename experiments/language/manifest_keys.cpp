#include "experiments/language/manifest_keys.hpp"

#include <algorithm>
#include <array>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {

std::span<const GeneralKey> general_keys() {
  static constexpr std::array<GeneralKey, 10> keys{{
      {"zerocount", "version of the manifest's format: 1", true},
      {"name", "name of the study", true},
      {"description", "what the study is for", false},
      {"seed", "seed of all random numbers, 0 to 2^64 - 1", true},
      {"trials", "trials at each design point", true},
      {"design", "how the trials are spread: monte_carlo (default), latin_hypercube or sobol", false},
      {"independent_points",
       "true: every design point has its own random numbers; false (default): all share those of trial i",
       false},
      {"retain", "trials whose sample-by-sample records are kept: {trials: [0, 1]}", false},
      {"observed", "what was observed on the real rig, by case or point label", false},
      {"sweep", "design points: grid (product of lists), cases (named), or both (product)", false},
  }};
  return keys;
}

std::vector<std::string> section_names() {
  std::vector<std::string> sections;
  for (const Parameter& parameter : parameter_table()) {
    const std::string section(parameter.name.substr(0, parameter.name.find('.')));
    if (sections.empty() || sections.back() != section) sections.push_back(section);
  }
  return sections;
}

std::vector<std::string> section_keys(std::string_view section) {
  std::vector<std::string> keys;
  for (const Parameter& parameter : parameter_table()) {
    const std::size_t dot = parameter.name.find('.');
    if (parameter.name.substr(0, dot) == section) keys.emplace_back(parameter.name.substr(dot + 1));
  }
  return keys;
}

std::vector<std::string> top_level_keys() {
  std::vector<std::string> keys;
  for (const GeneralKey& key : general_keys()) keys.emplace_back(key.name);
  for (std::string& section : section_names()) keys.push_back(std::move(section));
  return keys;
}

std::span<const std::string_view> design_words() {
  static constexpr std::array<std::string_view, 3> words{"monte_carlo", "latin_hypercube", "sobol"};
  return words;
}

}  // namespace zerocount

#include "experiments/yaml/unknown_key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/yaml/nearest_name.hpp"

namespace zerocount {
namespace {

// The parameter whose last name is `key`, or nothing.
std::string_view same_name_elsewhere(std::string_view key) {
  for (const Parameter& parameter : parameter_table()) {
    if (parameter.name.substr(parameter.name.rfind('.') + 1) == key) return parameter.name;
  }
  return {};
}

}  // namespace

void add_unknown_key(const Field& map, const YamlEntry& entry, std::span<const std::string> known,
                     Problems& problems) {
  const std::string path = entry_of(map, entry).path;
  const std::string_view elsewhere = same_name_elsewhere(entry.key);
  const std::string_view nearest = elsewhere.empty() ? nearest_name(entry.key, known) : elsewhere;
  const std::string what =
      nearest.empty() ? "unknown key" : fmt::format("unknown key, nearest known: {}", nearest);
  constexpr std::size_t most_listed = 20;
  const std::string expected =
      known.size() <= most_listed
          ? fmt::format("one of {}", fmt::join(known, ", "))
          : std::string("a dotted path of the table of parameters, such as controller.ki");
  problems.add(entry.place, path, what, expected);
}

}  // namespace zerocount

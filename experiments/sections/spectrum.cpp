#include "experiments/sections/spectrum.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/parameters/unknown_key.hpp"

namespace zerocount::sections {
namespace {

constexpr const char* pairs =
    "a list of at least two pairs [frequency in Hz, density], by ascending frequency, or a file of them";
constexpr std::size_t max_spectrum_points = 10000;
constexpr int max_lines = 1000;
constexpr double max_frequency = 1e9;  // Hz
constexpr double max_density = 1e12;

/// The point of a pair, if it is one and its frequency is above `last` (Hz).
std::optional<trial::SpectrumPoint> read_point(const yaml::Field& pair, double last,
                                               yaml::Problems& problems) {
  constexpr const char* expected = "a pair [frequency in Hz, density]";
  if (!yaml::check_list(pair, expected, problems)) return std::nullopt;
  if (pair.node->items.size() != 2) {
    problems.add(pair, fmt::format("found a list of {}", pair.node->items.size()), expected);
    return std::nullopt;
  }
  const auto frequency = yaml::read_real(yaml::item_of(pair, 0), numerics::above(last), problems);
  const auto density = yaml::read_real(yaml::item_of(pair, 1), numerics::at_least(0), problems);
  if (!frequency || !density) return std::nullopt;
  if (*frequency > max_frequency || *density > max_density) {
    problems.add(pair, fmt::format("found [{}, {}]", *frequency, *density),
                 "a frequency of at most 1e9 Hz, and a density of at most 1e12");
    return std::nullopt;
  }
  return trial::SpectrumPoint{*frequency, *density};
}

}  // namespace

bool is_spectrum(const yaml::Field& element) {
  return element.node->kind == yaml::YamlNode::Kind::map && yaml::find_field(element, "spectrum");
}

std::shared_ptr<const trial::SpectrumParameters> read_spectrum(const yaml::Field& element,
                                                               yaml::Problems& problems) {
  const std::vector<std::string> known{"spectrum", "lines"};
  parameters::check_keys(element, known, problems);
  trial::SpectrumParameters spectrum;
  if (const auto lines = yaml::find_field(element, "lines")) {
    const auto count = yaml::read_whole(*lines, 1, max_lines, problems);
    if (count) spectrum.lines = static_cast<int>(*count);
  }
  const yaml::Field list = yaml::find_field(element, "spectrum").value();
  if (!yaml::check_list(list, pairs, problems)) return nullptr;
  const std::size_t count = list.node->items.size();
  if (count < 2 || count > max_spectrum_points) {
    problems.add(list, fmt::format("found a list of {}", count), pairs);
    return nullptr;
  }
  double last = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto point = read_point(yaml::item_of(list, i), last, problems);
    if (!point) return nullptr;
    last = point->frequency;
    spectrum.density.push_back(*point);
  }
  return std::make_shared<const trial::SpectrumParameters>(std::move(spectrum));
}

}  // namespace zerocount::sections

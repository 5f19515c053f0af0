#include "analysis/report/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "analysis/report/embedded_files.hpp"

namespace zerocount {

Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption) {
  Figure figure{std::move(name), std::move(title), std::move(caption), {}, {}};
  figure.specification =
      nlohmann::ordered_json::parse(embedded_file(fmt::format("{}.vl.json", specification)));
  return figure;
}

void set_rows(Figure& figure, std::size_t rows, int row) {
  figure.specification["height"] = static_cast<int>(rows) * row;
}

nlohmann::ordered_json datum(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double rounded = std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

nlohmann::ordered_json round_numbers(double low, double high, double smallest) {
  const double largest = std::max(std::abs(low), std::abs(high));
  const bool many = largest > 300.0 * smallest;
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  const auto add = [&](double value) {
    if (value >= low && value <= high) numbers.push_back(datum(value));
  };
  add(0.0);
  for (int power = static_cast<int>(std::floor(std::log10(smallest))); std::pow(10.0, power) <= largest;
       ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      if (value < 0.999 * smallest || (many && digit != 1.0)) continue;
      add(value);
      add(-value);
    }
  }
  return numbers;
}

void set_number_format(nlohmann::ordered_json& axis, double largest) {
  if (largest < 0.01) axis["labelExpr"] = "datum.value === 0 ? '0' : format(datum.value, '~e')";
}

bool spaced_by_ratio(const std::vector<double>& sorted) {
  if (sorted.size() < 3 || sorted.front() <= 0.0) return false;
  const double steps = static_cast<double>(sorted.size() - 1);
  const double ratio = std::log(sorted.back() / sorted.front()) / steps;
  const double difference = (sorted.back() - sorted.front()) / steps;
  double by_ratio = 0.0;
  double by_difference = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double step = static_cast<double>(i);
    by_ratio += std::abs(std::log(sorted[i] / sorted.front()) - step * ratio) / (steps * ratio);
    by_difference += std::abs(sorted[i] - sorted.front() - step * difference) / (steps * difference);
  }
  return by_ratio < by_difference;
}

}  // namespace zerocount

#include "runners/tuning/limits_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::tuning {

nlohmann::ordered_json limits_array(const std::vector<Limit>& limits) {
  using Json = nlohmann::ordered_json;
  Json json = Json::array();
  for (const Limit& one : limits)
    json.push_back({{"cause", one.cause},
                    {"rate", one.rate ? Json(*one.rate) : Json()},
                    {"note", one.note.empty() ? Json() : Json(one.note)}});
  return json;
}

std::string limits_json(const std::vector<Limit>& limits) {
  return text::json_text({{"limits", limits_array(limits)}});
}

std::string limits_text(const std::vector<Limit>& limits, const goal::Question& question) {
  std::vector<text::TextColumn> columns{
      {"idealisation", false, {}},
      {fmt::format("{} that {}{}", is_of_machines(question) ? "machines" : "moves", words_of(question).meet,
                   question.worlds > 0 ? " (worst world)" : ""),
       true,
       {}},
      {"of the failures", true, {}},
      {"remark", false, {}}};
  std::string left_out;
  const double base = limits.front().rate.value();
  for (const Limit& one : limits) {
    if (!one.rate) {
      left_out += fmt::format("{} is not simulated: {}\n", one.cause, one.note);
      continue;
    }
    columns[0].cells.push_back(one.cause);
    columns[1].cells.push_back(fmt::format("{:.2f} %", 100.0 * *one.rate));
    const double proportion = base < 1.0 ? (*one.rate - base) / (1.0 - base) : 0.0;
    columns[2].cells.push_back(
        &one == &limits.front() || base == 1.0
            ? ""
            : fmt::format("{:.0f} % {}", std::abs(100.0 * proportion), proportion >= 0.0 ? "fewer" : "more"));
    columns[3].cells.push_back(one.note);
  }
  return text::aligned_table(columns) + left_out;
}

}  // namespace zerocount::tuning

#include "analysis/report/first_screen/gains.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/report/first_screen/point_values.hpp"
#include "analysis/report/first_screen/quantity.hpp"
#include "analysis/report/html.hpp"
#include "analysis/theory/point_theory.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "experiments/rules/value_sources.hpp"

namespace zerocount::report {
namespace {

/// The parameter in the section tune; null where tune does not change it.
const study::FreeParameter* free_parameter(const study::Study& study, std::string_view name) {
  if (!study.tuning) return nullptr;
  const auto found = std::ranges::find(study.tuning->free, name, &study::FreeParameter::name);
  return found == study.tuning->free.end() ? nullptr : &*found;
}

/// "default", or the range in which tune seeks the value.
std::string note_of(const study::Study& study, const rules::SourcedValue& value) {
  const study::FreeParameter* const free = free_parameter(study, study.plan->table.rows[value.slot].name);
  if (free != nullptr) return range_text(free->low, free->high, "");
  return value.source == rules::ValueSource::assumed ? "default" : "";
}

/// "kp" for "controller.kp".
std::string short_name(std::string_view name) {
  constexpr std::string_view section = "controller.";
  return std::string(name.starts_with(section) ? name.substr(section.size()) : name);
}

/// "11.3 … 11.5 dB" on one line; "–" where no trial has one.
std::string margin_text(const theory::Range& range, std::string_view unit) {
  if (range.empty()) return "–";
  const auto number = [](double value) { return fmt::format("{:.3g}", value); };
  const std::string low = number(range.low);
  const std::string high = number(range.high);
  return (low == high ? low : low + "\u00a0…\u00a0" + high) + std::string(unit);
}

}  // namespace

bool is_chosen(const study::Study& study, std::size_t slot) {
  const std::string_view name = study.plan->table.rows[slot].name;
  if (free_parameter(study, name) != nullptr) return true;
  return name.starts_with("controller.") && name != "controller.delay" && name != "controller.jitter" &&
         name != "controller.missed";
}

std::string gains_html(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  std::vector<HtmlColumn> columns{{"controller", "", true, {}},
                                  {"value", "", true, {}},
                                  {study.tuning ? "range of tune" : "", "", true, {}}};
  for (const rules::SourcedValue& one : rules::value_sources(*study.plan)) {
    const parameters::Parameter& parameter = study.plan->table.rows[one.slot];
    const bool is_word = one.source == rules::ValueSource::assumed && parameters::has_labels(parameter);
    if (is_chosen(study, one.slot) && !is_word)
      add_row(columns, {short_name(parameter.name), values.text(one.slot), note_of(study, one)});
  }
  return html_table(columns);
}

std::string loops_html(const study::Study& study, std::int64_t point) {
  if (theory::has_no_linear_loop(study::study_trial(study, point, 0).parameters)) return "";
  const bool has_conditions = !study.conditions.empty();
  std::vector<HtmlColumn> columns{{"loop", "", true, {}},
                                  {"gain margin", "", true, {}},
                                  {"phase margin", "", true, {}},
                                  {"crossover", "", true, {}}};
  if (has_conditions) columns.insert(columns.begin(), {"condition", "", true, {}});
  std::vector<theory::KnownRotor> rotors;
  for (std::int64_t condition = 0; condition < study::condition_count(study); ++condition) {
    for (const theory::LoopRanges& loop : theory::examine(study, point, condition, rotors).loops) {
      const std::string verdict = theory::stability_text(loop);
      std::vector<std::string> cells{loop.name + (verdict == "stable" ? "" : ": " + verdict),
                                     margin_text(loop.gain, "\u00a0dB"), margin_text(loop.phase, "°"),
                                     margin_text(loop.phase_at, "\u00a0Hz")};
      if (has_conditions) cells.insert(cells.begin(), study.conditions[static_cast<std::size_t>(condition)]);
      add_row(columns, std::move(cells));
    }
  }
  return html_table(columns);
}

}  // namespace zerocount::report

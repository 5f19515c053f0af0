#include "analysis/report/first_screen/assumptions.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/first_screen/gains.hpp"
#include "analysis/report/first_screen/point_values.hpp"
#include "experiments/rules/value_sources.hpp"

namespace zerocount::report {
namespace {

using rules::ValueSource;

/// "plant.inertia 3.2 … 4.6 kg", with how often a drawn value is drawn. The section is left out after another
/// value of it. @param section of the value before
std::string value_html(const PointValues& values, std::size_t slot, std::string& section) {
  std::string name(values.study().plan->table.rows[slot].name);
  const std::size_t key = name.rfind('.') + 1;
  const bool is_same = name.substr(0, key) == section;
  section = name.substr(0, key);
  const std::string drawn = values.draw_text(slot);
  return fmt::format("<span><b>{}</b> {}{}</span>", document::markup(is_same ? name.substr(key) : name),
                     document::markup(values.text(slot)), drawn.empty() ? "" : ", " + drawn);
}

/// A source and what comes from it. @param items HTML; without any there is no row
std::string row_html(const std::string& source, const std::vector<std::string>& items) {
  if (items.empty()) return "";
  std::string html = fmt::format("<tr><th>{}</th><td>", document::markup(source));
  for (const std::string& item : items) html += item + " ";
  return html + "</td></tr>\n";
}

std::vector<std::string> values_from(ValueSource source, const std::vector<rules::SourcedValue>& all,
                                     const PointValues& values) {
  std::vector<std::string> items;
  std::string section;
  for (const rules::SourcedValue& one : all) {
    if (one.source == source && !is_chosen(values.study(), one.slot))
      items.push_back(value_html(values, one.slot, section));
  }
  return items;
}

std::vector<std::string> absent(const study::Study& study, study::PremiseState state) {
  std::vector<std::string> items;
  for (const study::Premise& premise : study.premises) {
    if (premise.state == state)
      items.push_back(fmt::format("<span>{}</span>", document::markup(premise.assumption)));
  }
  return items;
}

}  // namespace

std::string assumptions_html(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  const std::vector<rules::SourcedValue> all = rules::value_sources(*study.plan);
  const std::string samples = study.samples ? "samples of " + study.samples->file : "";
  return "<table class=\"assumptions\"><tbody>\n" +
         row_html("measured", values_from(ValueSource::measured, all, values)) +
         row_html(samples, values_from(ValueSource::sampled, all, values)) +
         row_html("given in the manifest", values_from(ValueSource::given, all, values)) +
         row_html("assumed: defaults", values_from(ValueSource::assumed, all, values)) +
         row_html("stated as absent", absent(study, study::PremiseState::stated_none)) +
         row_html("assumed away", absent(study, study::PremiseState::assumed)) + "</tbody></table>\n";
}

}  // namespace zerocount::report

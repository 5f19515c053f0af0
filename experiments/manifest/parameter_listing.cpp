#include "experiments/manifest/parameter_listing.hpp"

#include <algorithm>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/guides/guide_friction.hpp"
#include "experiments/manifest/drawn_per.hpp"
#include "experiments/manifest/manifest_keys.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount::manifest {
namespace {

using Row = std::vector<std::string>;

struct Listing {
  std::string title;
  Row heads;
  std::vector<Row> rows;
};

std::string allowed(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  if (parameters::has_labels(parameter)) return fmt::format("{}", fmt::join(parameter.labels, " | "));
  return (parameter.kind == parameters::ParameterKind::whole_number ? "whole, " : "") +
         numerics::notation(parameters::range_of(parameter, units)) + (parameter.none ? " | none" : "");
}

std::string number_text(double number) {
  return fmt::format("{:.3g}", number);
}

/// The default; without one the range over the guides, if they have the parameter.
std::string default_or_guides(const parameters::Parameter& p, const parameters::StudyUnits& units) {
  if (!parameters::default_holds(p, units)) {
    if (const auto range = guides::range_over_guides(units.axis, p.name))
      return fmt::format("guides: {} to {}", number_text(range->first), number_text(range->second));
  }
  return parameters::default_text(p, units);
}

Row parameter_row(const parameters::Parameter& p, const parameters::StudyUnits& units) {
  const std::string meaning =
      parameters::meaning_of(p, units) + (p.profiled != nullptr ? " [profile allowed]" : "");
  return {std::string(p.name),
          parameters::unit_of(p, units),
          default_or_guides(p, units),
          allowed(p, units),
          parameters::default_holds(p, units) ? std::string(p.source) : "-",
          meaning};
}

Listing parameter_listing(std::string title) {
  return {std::move(title), {"name", "unit", "default", "allowed", "source of the default", "meaning"}, {}};
}

Listing parameter_listing(const parameters::StudyUnits& units) {
  Listing listing = parameter_listing("Parameters and their defaults");
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (parameters::exists_on(parameter, units.axis)) listing.rows.push_back(parameter_row(parameter, units));
  }
  return listing;
}

Listing parameter_listing(const study::Study& study) {
  Listing listing = parameter_listing(fmt::format("Parameters of the study {}", study.name));
  const study::StudyTable& table = study.plan->table;
  for (const std::size_t slot : study::slots_in_table_order(table)) {
    if (parameters::exists_on(table.rows[slot], study.units.axis))
      listing.rows.push_back(parameter_row(table.rows[slot], study.units));
  }
  return listing;
}

Listing distribution_listing(const parameters::StudyUnits& units) {
  Listing listing{"Distributions (allowed in place of any number)", {"name", "written", "meaning"}, {}};
  for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
    listing.rows.push_back({std::string(form.name),
                            fmt::format("{{{}: {}}}", form.name, distributions::shown_value(form)),
                            std::string(form.meaning)});
  }
  listing.rows.push_back(
      {"profile", "{profile: {mean, cv, correlation_length, marginal}}",
       parameters::text_on(units.axis, "friction along the $track") +
           fmt::format(": a periodic random field; correlation_length in {}, marginal normal or lognormal "
                       "(default); the mean may be a distribution, drawn for each {}",
                       parameters::unit_on(units.axis, "rad"), parameters::text_on(units.axis, "$rotor"))});
  listing.rows.push_back({std::string(per_key), fmt::format("{{…, per: {}}}", fmt::join(per_labels, " | ")),
                          "beside any of these: how often the value is drawn; contact only for friction, "
                          "study or rig only for a profile"});
  return listing;
}

Listing key_listing() {
  Listing listing{"Other keys of a manifest", {"name", "required", "meaning"}, {}};
  for (const GeneralKey& key : general_keys()) {
    listing.rows.push_back({std::string(key.name), key.required ? "yes" : "no", std::string(key.meaning)});
  }
  return listing;
}

Listing guide_listing() {
  Listing listing{"Quantities of the guides",
                  {"guide", "quantity", "unit", "low", "high", "origin", "source or reason"},
                  {}};
  for (const guides::Guide& guide : guides::guide_table()) {
    for (const guides::GuideNumber& number : guide.numbers) {
      listing.rows.push_back({std::string(guide.name), std::string(number.quantity), std::string(number.unit),
                              number_text(number.low), number_text(number.high),
                              std::string(guides::origin_labels[static_cast<std::size_t>(number.origin)]),
                              number.source});
    }
  }
  return listing;
}

Listing guide_parameter_listing() {
  Listing listing{"Parameters of the guides with their usual mass and preload",
                  {"guide", "mass", "preload (N)", "parameter", "unit", "low", "high", "origin"},
                  {}};
  for (const guides::Guide& guide : guides::guide_table()) {
    const guides::GuideLoad load = guides::usual_load(guide);
    for (const guides::GuideNumber& number : guides::guide_parameters(guide, load)) {
      listing.rows.push_back(
          {std::string(guide.name),
           fmt::format("{} {}", number_text(load.mass), parameters::unit_on(guide.axis, "kg m^2")),
           guides::has_load(guide) ? number_text(load.preload) : "-", std::string(number.quantity),
           std::string(number.unit), number_text(number.low), number_text(number.high),
           std::string(guides::origin_labels[static_cast<std::size_t>(number.origin)])});
    }
  }
  return listing;
}

/// Characters of UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

/// A table with a line below its heads, by which it is known as one where it is fitted to a terminal.
std::string as_text(const Listing& listing) {
  std::vector<std::size_t> widths(listing.heads.size(), 0);
  std::vector<Row> lines{listing.heads, Row(listing.heads.size())};
  lines.insert(lines.end(), listing.rows.begin(), listing.rows.end());
  for (const Row& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], width_of(line[i]));
  }
  for (std::size_t i = 0; i < widths.size(); ++i) {
    for (std::size_t k = 0; k < widths[i]; ++k) lines[1][i] += "─";
  }
  std::string text = listing.title + "\n\n";
  for (const Row& line : lines) {
    std::string shown;
    for (std::size_t i = 0; i < line.size(); ++i) shown += fmt::format("{:<{}}  ", line[i], widths[i]);
    text += shown.substr(0, shown.find_last_not_of(' ') + 1) + "\n";
  }
  return text + "\n";
}

// Escapes bars, which separate cells.
std::string cell(const std::string& text) {
  return boost::algorithm::replace_all_copy(text, "|", "\\|");
}

std::string as_markdown(const Listing& listing) {
  std::string text = fmt::format("## {}\n\n| {} |\n|{}\n", listing.title, fmt::join(listing.heads, " | "),
                                 fmt::join(std::vector<std::string>(listing.heads.size(), " --- |"), ""));
  for (const Row& row : listing.rows) {
    Row cells;
    for (const std::string& entry : row) cells.push_back(cell(entry));
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  }
  return text + "\n";
}

std::string in_form(std::string (*form)(const Listing&), const parameters::StudyUnits& units) {
  return form(parameter_listing(units)) + form(distribution_listing(units)) + form(key_listing());
}

}  // namespace

std::string parameters_as_text(const parameters::StudyUnits& units) {
  return in_form(as_text, units);
}

std::string parameters_as_markdown(const parameters::StudyUnits& units) {
  return in_form(as_markdown, units);
}

std::string parameters_as_text(const study::Study& study) {
  return as_text(parameter_listing(study));
}

std::string parameters_as_markdown(const study::Study& study) {
  return as_markdown(parameter_listing(study));
}

std::string guides_as_text() {
  return as_text(guide_listing()) + as_text(guide_parameter_listing());
}

std::string guides_as_markdown() {
  return as_markdown(guide_listing()) + as_markdown(guide_parameter_listing());
}

}  // namespace zerocount::manifest

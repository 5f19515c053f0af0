#include "experiments/manifest/parameter_listing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/guides/guide_manifest.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {
namespace {

std::string allowed(const parameters::Parameter& parameter) {
  if (parameters::has_labels(parameter)) return fmt::format("{}", fmt::join(parameter.labels, " | "));
  return (parameter.kind == parameters::ParameterKind::whole_number ? "whole, " : "") +
         numerics::notation(parameter.range) + (parameter.none ? " | none" : "");
}

/// Text of the parameter's default. Without a default it is the range over the known guides, if they have the
/// parameter.
std::string default_or_guides(const parameters::Parameter& p, const parameters::StudyUnits& units) {
  if (!parameters::default_holds(p, units)) {
    if (const auto range = guides::range_over_guides(units.axis, p.name))
      return fmt::format("guides: {:.3g} to {:.3g}", range->first, range->second);
  }
  return parameters::default_text(p, units);
}

ListedParameter listed(const parameters::Parameter& p, const parameters::StudyUnits& units) {
  return {std::string(p.name),
          parameters::unit_of(p, units),
          default_or_guides(p, units),
          allowed(p),
          parameters::default_holds(p, units) ? std::string(p.source) : "-",
          parameters::meaning_of(p, units) + (p.profiled != nullptr ? " [profile allowed]" : "")};
}

}  // namespace

std::vector<ListedParameter> listed_parameters(const parameters::StudyUnits& units) {
  std::vector<ListedParameter> rows;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (parameters::exists_on(parameter, units.axis)) rows.push_back(listed(parameter, units));
  }
  return rows;
}

std::vector<ListedParameter> listed_parameters(const study::Study& study) {
  std::vector<ListedParameter> rows;
  const study::StudyTable& table = study.plan->table;
  for (const std::size_t slot : study::slots_in_table_order(table)) {
    if (parameters::exists_on(table.rows[slot], study.units.axis))
      rows.push_back(listed(table.rows[slot], study.units));
  }
  return rows;
}

std::vector<ListedDistribution> listed_distributions(const parameters::StudyUnits& units) {
  std::vector<ListedDistribution> rows;
  for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
    rows.push_back({std::string(form.name),
                    fmt::format("{{{}: {}}}", form.name, distributions::shown_value(form)),
                    std::string(form.meaning)});
  }
  rows.push_back(
      {"profile", "{profile: {mean, cv, correlation_length, marginal}}",
       parameters::text_on(units.axis, "friction along the $track") +
           fmt::format(
               ": a periodic random field; correlation_length in {}, marginal normal or lognormal (default); "
               "the mean may be a distribution, drawn for each {}",
               parameters::unit_on(units.axis, "rad"), parameters::text_on(units.axis, "$rotor"))});
  rows.push_back(
      {std::string(keys::per_key), fmt::format("{{…, per: {}}}", fmt::join(keys::draw_level_labels, " | ")),
       "beside any of these: how often the value is drawn; contact only for friction, study or machine only for a profile"});
  return rows;
}

}  // namespace zerocount::manifest

#include "analysis/law_identification/law_identification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/identification/confidence_interval.hpp"
#include "analysis/law_identification/law_fit.hpp"
#include "core/failure/failure.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {
namespace {

using identification::EstimateStatus;
using identification::ParameterEstimate;

/// Largest half-widths of an interval that was widened because the law does not fit.
constexpr double max_widened_log_halfwidth = 2.3;  // a factor of 10 to each side
constexpr double max_widened_halfwidth = 2.0;

ParameterEstimate estimate_of(const Quantity& quantity, const LawErrors& errors) {
  const record_fit::QuantityEstimate found =
      record_fit::interval_of_errors(quantity, errors.errors, errors.checks.widening);
  ParameterEstimate estimate{record_fit::on_parameter_scale(quantity, found), quantity.name, quantity.key,
                             quantity.unit, EstimateStatus::estimated};
  // The fit of the law does not change which parameters the records determine.
  const double widened = found.half_width();
  const double half_width = widened / errors.checks.widening;
  const bool open = !(half_width <= record_fit::max_half_width(quantity.logarithmic));
  const bool vague = !(widened <= (quantity.logarithmic ? max_widened_log_halfwidth : max_widened_halfwidth));
  if (open || vague) {
    leave_open(estimate, open ? "the records hardly depend on it"
                              : "the law departs too far from the records to tell it");
  }
  return estimate;
}

/// Root mean square of the residuals over all records, rad, and the same over the travel.
void set_misfit(Records records, const LawFit& fit, IdentifiedLaw& law) {
  double squares = 0.0;
  double relative = 0.0;
  double readings = 0.0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto [low, high] = std::minmax_element(records[r].reading.begin(), records[r].reading.end());
    for (const double residual : fit.residuals[r]) {
      squares += residual * residual * records[r].unit * records[r].unit;
      relative += residual * residual / ((*high - *low) * (*high - *low));
    }
    readings += static_cast<double>(fit.residuals[r].size());
  }
  law.misfit = std::sqrt(squares / readings);
  law.misfit_over_travel = std::sqrt(relative / readings);
}

double mean_square(const std::vector<double>& residuals) {
  double squares = 0.0;
  for (const double residual : residuals) squares += residual * residual;
  return squares / static_cast<double>(residuals.size());
}

/// A fit with its law.
struct FittedLaw {
  LawModel model;
  LawFit fit;
  IdentifiedLaw law;
};

/// The number of independent residuals of each record, from those of the law with the least squares.
std::vector<double> effective_readings(Records records, const std::vector<FittedLaw>& fitted) {
  std::vector<double> effective;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto best =
        std::min_element(fitted.begin(), fitted.end(), [&](const FittedLaw& one, const FittedLaw& other) {
          return mean_square(one.fit.residuals[r]) < mean_square(other.fit.residuals[r]);
        });
    const std::vector<double>& residuals = best->fit.residuals[r];
    effective.push_back(static_cast<double>(residuals.size()) /
                        record_fit::residual_statistics(residuals).correlation_length);
  }
  return effective;
}

double information_criterion(const FittedLaw& fitted, const std::vector<double>& effective) {
  double criterion = 0.0;
  double all = 0.0;
  for (std::size_t r = 0; r < effective.size(); ++r) {
    criterion += effective[r] * std::log(mean_square(fitted.fit.residuals[r]));
    all += effective[r];
  }
  const auto parameters = static_cast<double>(fitted.law.fitted + effective.size());
  return criterion + parameters * std::log(all);
}

/// Refuses a state at the start of a record that the law does not have.
void require_start(Records records, friction::FrictionModel law) {
  const friction::LawTraits& traits = friction::traits_of(law);
  for (const TestRecord& record : records) {
    const bool loaded = record.start.preload != 0.0 || !record.start.history.empty();
    const bool hardened = record.start.hardening != 0.0;
    if (!(loaded && !traits.remembers_loading) && !(hardened && !friction::has_creep(law))) continue;
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the record begins {}, which the friction model {} does not remember; leave "
                    "that model out",
                    record.name, hardened ? "work-hardened" : "after a preload", traits.word));
  }
}

/// The law as a fragment of a manifest.
std::string law_fragment(Records records, const FittedLaw& fitted) {
  const IdentifiedLaw& law = fitted.law;
  identification::Fragment fragment;
  for (const TestRecord& record : records) fragment.records.push_back(record.name);
  fragment.remarks = "\n";
  for (const ParameterEstimate& parameter : law.parameters) {
    if (parameter.name != "series_compliance" || !is_estimated(parameter)) continue;
    fragment.remarks += fmt::format("# A fixture gives way by {} {}; a manifest has none.\n",
                                    identification::with_digits(parameter.value, parameter), parameter.unit);
  }
  fragment.remarks += identification::lack_of_fit_comment(law.checks.passed);
  fragment.plant = fitted.model.plant_lines + identification::manifest_lines(law.parameters, "plant");
  fragment.friction =
      fmt::format("  model: {}\n{}{}", friction::traits_of(law.law).word,
                  identification::manifest_lines(law.parameters, "friction"),
                  parameters::unit_on(law.axis, fitted.model.fixed_lines(fitted.fit.model.point.axis)));
  return identification::fragment_text(fragment, law.axis);
}

FittedLaw fitted_law(Records records, friction::FrictionModel law, bool series_compliance,
                     const RecordScales& scales, double least_squares) {
  FittedLaw result;
  result.model = law_model(law, scales, records);
  if (series_compliance) result.model = with_series_compliance(result.model, scales);
  result.fit = fit_law(records, result.model, least_squares);
  const LawErrors errors = errors_of(records, result.fit);
  IdentifiedLaw& found = result.law;
  found.law = law;
  found.axis = records.front().axis;
  found.fitted =
      static_cast<std::size_t>(std::count(result.model.free.begin(), result.model.free.end(), true));
  found.checks = errors.checks;
  found.converged = result.fit.converged;
  set_misfit(records, result.fit, found);
  for (const Quantity& quantity : result.model.quantities_at(result.fit.model.point.axis)) {
    found.parameters.push_back(estimate_of(quantity, errors));
    std::string& unit = found.parameters.back().unit;
    unit = parameters::unit_on(found.axis, unit);
  }
  found.fragment = law_fragment(records, result);
  return result;
}

}  // namespace

std::vector<std::string> law_words() {
  std::vector<std::string> words;
  for (const friction::FrictionModel law : fitted_laws()) words.emplace_back(friction::traits_of(law).word);
  return words;
}

friction::FrictionModel law_of(const std::string& word) {
  const auto laws = fitted_laws();
  return *std::find_if(laws.begin(), laws.end(),
                       [&](friction::FrictionModel law) { return friction::traits_of(law).word == word; });
}

LawComparison compare_laws(std::vector<TestRecord> records, const LawChoice& choice,
                           const identification::StageReport& report) {
  identification::check_different(records);
  for (const friction::FrictionModel law : choice.laws) require_start(records, law);
  for (TestRecord& record : records) record.parts = parts_of(record);
  const auto enter = [&](std::string_view stage) {
    if (report) report(stage);
  };
  enter("starting values");
  const RecordScales scales = scales_of(records);
  std::vector<FittedLaw> fitted;
  double least_squares = std::numeric_limits<double>::infinity();
  for (const friction::FrictionModel law : choice.laws) {
    enter(fmt::format("fit of {}", friction::traits_of(law).word));
    fitted.push_back(fitted_law(records, law, choice.series_compliance, scales, least_squares));
    least_squares = std::min(least_squares, fitted.back().fit.squares);
  }
  const std::vector<double> effective = effective_readings(records, fitted);
  LawComparison comparison;
  comparison.axis = records.front().axis;
  comparison.sample_time = records.front().sample_time;
  for (std::size_t r = 0; r < records.size(); ++r) {
    comparison.effective_readings += effective[r];
    comparison.readings += used_samples(records[r]);
    comparison.records.push_back(identification::extent_of(records[r]));
  }
  for (FittedLaw& one : fitted) {
    one.law.information_criterion = information_criterion(one, effective);
    comparison.laws.push_back(std::move(one.law));
  }
  std::stable_sort(comparison.laws.begin(), comparison.laws.end(),
                   [](const IdentifiedLaw& one, const IdentifiedLaw& other) {
                     return one.information_criterion < other.information_criterion;
                   });
  const double least = comparison.laws.front().information_criterion;
  for (IdentifiedLaw& law : comparison.laws) law.information_criterion -= least;
  return comparison;
}

}  // namespace zerocount::law_identification

#include "analysis/record/fit/laws/law_identification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "analysis/record/fit/observations.hpp"
#include "core/failure/failure.hpp"
#include "core/friction/law.hpp"

namespace zerocount::fit {
namespace {

/// Largest half-width (of a logarithm, then of other coordinates) that an interval may have after it was
/// widened because the law does not fit.
constexpr double max_widened_log_halfwidth = 2.3;  // a factor of 10 to each side
constexpr double max_widened_halfwidth = 2.0;

/// Number of simulated replicates of the readings, from which the errors of a fit are estimated.
constexpr std::size_t replicates = 300;

ParameterEstimate estimate_of(const Quantity& quantity, const FitErrors& errors) {
  const QuantityEstimate found = interval_of_errors(quantity, errors.errors, errors.checks.widening);
  ParameterEstimate estimate{on_parameter_scale(quantity, found), quantity.name, quantity.key, quantity.unit,
                             EstimateStatus::estimated};
  // The fit of the law does not change which parameters the records determine.
  const double widened = found.half_width();
  const double half_width = widened / errors.checks.widening;
  const bool open = !(half_width <= max_half_width(quantity.logarithmic));
  const bool vague = !(widened <= (quantity.logarithmic ? max_widened_log_halfwidth : max_widened_halfwidth));
  if (open || vague) {
    leave_open(estimate, open ? "the records hardly depend on it"
                              : "the law departs too far from the records to determine it");
  }
  return estimate;
}

/// Sets the misfit of the law: the root mean square of the residuals over all records, rad, and the same
/// divided by the travel.
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

/// A friction law with its fit to the records.
struct FittedLaw {
  FitModel model;
  LawFit fit;
  FitErrors errors;
  IdentifiedLaw law;
};

/// [record] Number of independent residuals, computed from the residuals of the law with the smallest sum of
/// squares for this record.
std::vector<double> effective_readings(Records records, const std::vector<FittedLaw>& fitted) {
  std::vector<double> effective;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const auto best =
        std::min_element(fitted.begin(), fitted.end(), [&](const FittedLaw& one, const FittedLaw& other) {
          return mean_square(one.fit.residuals[r]) < mean_square(other.fit.residuals[r]);
        });
    const std::vector<double>& residuals = best->fit.residuals[r];
    effective.push_back(static_cast<double>(residuals.size()) /
                        residual_statistics(residuals).correlation_length);
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

/// Throws a Failure if a record starts in a state of the contact that the law does not have.
void require_start(Records records, friction::FrictionModel law) {
  const friction::LawTraits& traits = friction::traits_of(law);
  for (const TestRecord& record : records) {
    const bool loaded = record.start.preload != 0.0 || !record.start.history.empty();
    const bool hardened = record.start.hardening != 0.0;
    if (!(loaded && !traits.remembers_loading) && !(hardened && !friction::has_creep(law))) continue;
    refuse(record.axis, record.name,
           fmt::format("the record begins {}, which the friction model {} cannot represent",
                       hardened ? "work-hardened" : "after a preload", traits.word));
  }
}

/// Text with the reasons why laws were left out, one per line.
std::string reasons_of(const std::vector<LawLeftOut>& laws) {
  std::string text;
  for (const LawLeftOut& law : laws) text += (text.empty() ? "" : "\n") + law.reason;
  return text;
}

/// The fitted law with its parameters as text for a manifest.
std::string law_fragment(Records records, const FittedLaw& fitted) {
  const IdentifiedLaw& law = fitted.law;
  Fragment fragment;
  for (const TestRecord& record : records) fragment.records.push_back(record.name);
  fragment.remarks = "\n";
  for (const ParameterEstimate& parameter : law.parameters) {
    if (parameter.name != "series_compliance" || !is_estimated(parameter)) continue;
    fragment.remarks += fmt::format("# A fixture gives way by {} {}; a manifest has none.\n",
                                    with_digits(parameter.value, parameter), parameter.unit);
  }
  fragment.remarks += lack_of_fit_comment(law.checks.passed);
  fragment.plant = manifest_lines(law.parameters, "plant");
  const auto slides = std::ranges::find(law.parameters, "sliding_damping", &ParameterEstimate::name);
  if (slides != law.parameters.end() && !is_estimated(*slides)) fragment.plant += fitted.model.plant_lines;
  const std::string fixed =
      fitted.model.fixed_lines ? fitted.model.fixed_lines(fitted.fit.model.point.axis) : "";
  fragment.friction =
      fmt::format("  model: {}\n{}{}", friction::traits_of(law.law).word,
                  manifest_lines(law.parameters, "friction"), parameters::unit_on(law.axis, fixed));
  return fragment_text(fragment, law.axis);
}

FittedLaw fitted_law(Records records, friction::FrictionModel law, bool series_compliance,
                     const RecordScales& scales, double least_squares) {
  FittedLaw result;
  result.law.law = law;
  result.model = law_model(law, scales, records);
  if (series_compliance) result.model = with_series_compliance(result.model, scales);
  result.fit = fit_law(records, result.model, least_squares);
  result.errors = errors_of(records, result.fit, replicates);
  return result;
}

/// The fits of the chosen laws to the records. Laws that cannot be fitted are appended to `left_out`.
/// @param enter called with the name of each stage
std::vector<FittedLaw> first_fits(Records records, const LawChoice& choice, const StageReport& enter,
                                  std::vector<LawLeftOut>& left_out) {
  enter("starting values");
  const RecordScales scales = scales_of(records);
  std::vector<FittedLaw> fitted;
  double least_squares = std::numeric_limits<double>::infinity();
  for (const friction::FrictionModel law : choice.laws) {
    enter(fmt::format("fit of {}", friction::traits_of(law).word));
    try {
      require_start(records, law);
      fitted.push_back(fitted_law(records, law, choice.series_compliance, scales, least_squares));
      least_squares = std::min(least_squares, fitted.back().fit.squares);
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_data) throw;
      left_out.push_back({law, failure.what()});
    }
  }
  if (fitted.empty()) throw Failure(ExitCode::bad_data, reasons_of(left_out));
  return fitted;
}

/// Searches again for a better fit of the laws that do not explain the records. If another law does explain
/// them, laws with more than a hundred times the smallest sum of squares are not searched again.
void search_failed_again(Records records, const StageReport& enter, std::vector<FittedLaw>& fitted) {
  double least_squares = std::numeric_limits<double>::infinity();
  for (const FittedLaw& one : fitted) least_squares = std::min(least_squares, one.fit.squares);
  const bool explained =
      std::ranges::any_of(fitted, [](const FittedLaw& one) { return one.errors.checks.passed; });
  for (FittedLaw& one : fitted) {
    if (one.errors.checks.passed || (explained && one.fit.squares > hopeless * least_squares)) continue;
    enter(fmt::format("another fit of {}", friction::traits_of(one.law.law).word));
    try {
      auto fit = search_again(records, one.model, least_squares, one.fit);
      one.errors = errors_of(records, fit, replicates);
      one.fit = std::move(fit);
    } catch (const Failure& failure) {
      if (failure.code() != ExitCode::bad_data) throw;  // the first fit stays
    }
    least_squares = std::min(least_squares, one.fit.squares);
  }
}

/// Sets the reported results of a fitted law: its estimates, misfit and checks.
void describe(Records records, FittedLaw& fitted) {
  IdentifiedLaw& found = fitted.law;
  found.axis = records.front().axis;
  found.fitted =
      static_cast<std::size_t>(std::count(fitted.model.free.begin(), fitted.model.free.end(), true));
  found.checks = fitted.errors.checks;
  found.converged = fitted.fit.converged;
  set_misfit(records, fitted.fit, found);
  for (const Quantity& quantity : fitted.model.quantities_at(fitted.fit.model.point.axis)) {
    found.parameters.push_back(estimate_of(quantity, fitted.errors));
    std::string& unit = found.parameters.back().unit;
    unit = parameters::unit_on(found.axis, unit);
  }
  found.fragment = law_fragment(records, fitted);
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
                           const StageReport& report) {
  check_different(records);
  for (TestRecord& record : records) record.parts = parts_of(record);
  const auto enter = [&](std::string_view stage) {
    if (report) report(stage);
  };
  LawComparison comparison;
  std::vector<FittedLaw> fitted = first_fits(records, choice, enter, comparison.left_out);
  search_failed_again(records, enter, fitted);
  for (FittedLaw& one : fitted) describe(records, one);
  const std::vector<double> effective = effective_readings(records, fitted);
  comparison.axis = records.front().axis;
  comparison.sample_time = records.front().sample_time;
  for (std::size_t r = 0; r < records.size(); ++r) {
    comparison.effective_readings += effective[r];
    comparison.readings += used_samples(records[r]);
    comparison.records.push_back(extent_of(records[r]));
  }
  for (FittedLaw& one : fitted) {
    one.law.information_criterion = information_criterion(one, effective);
    comparison.laws.push_back(std::move(one.law));
  }
  std::ranges::stable_sort(comparison.laws, {}, [](const IdentifiedLaw& law) {
    return std::pair(!law.checks.passed, law.information_criterion);
  });
  const double least = comparison.laws.front().information_criterion;
  for (IdentifiedLaw& law : comparison.laws) law.information_criterion -= least;
  return comparison;
}

}  // namespace zerocount::fit

#include "analysis/record/fit/laws/law_identification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "analysis/record/fit/observations.hpp"
#include "analysis/record/fit/presliding/contact.hpp"
#include "core/failure/failure.hpp"
#include "core/friction/law.hpp"

namespace zerocount::fit {

namespace {

/// Maximum number of steps of a fit that is continued to its end.
constexpr int last_steps = 60;

/// Maximum number of steps for a law that fits so badly that it cannot win (see `hopeless`).
constexpr int hopeless_steps = 15;

FitSetting setting_of(const FitModel& model) {
  return {.model = model, .free = model.free, .prior = {}};
}

FitSetting without_time_offset(FitSetting setting) {
  setting.free.back() = false;
  return setting;
}

FitSetting with_steps(FitSetting setting, int steps) {
  setting.max_steps = steps;
  return setting;
}

/// Random starting points about `centres`, which are taken in turn. Of the free coordinates except the time
/// offset, about half move far, the others little. Most coordinates are logarithms of a parameter. If the
/// slow parts of the records have fixed the stiffness, such points try other orders of magnitude of inertia
/// and damping.
std::vector<Point> scattered(const FitModel& model, const std::vector<Point>& centres) {
  constexpr std::size_t points = 96;
  constexpr double near = 0.1;
  constexpr double far = 2.5;
  std::vector<Point> found;
  for (std::size_t i = 0; i < points; ++i) {
    Point point = centres[i % centres.size()];
    ReplicateNoise random(i);
    for (Eigen::Index j = 0; j + 1 < point.size(); ++j) {
      const double moved = random.next();
      const double spread = random.next() > 0.0 ? far : near;
      if (model.free[static_cast<std::size_t>(j)]) point[j] += spread * moved;
    }
    found.push_back(point);
  }
  return found;
}

/// Rounds of a search from scattered starting points: {number of points, steps for each} per round.
constexpr SearchRounds wide_search{{12, 3}, {6, 4}};

/// The best of short fits from the law's starting points; if none of these points can be simulated, from
/// random points about them.
std::vector<FitResult> first_minima(Records records, const FitModel& model, const Observations& readings,
                                    const FitSetting& setting) {
  std::vector<FitResult> minima = promising_fits(records, readings, model.starts, setting);
  if (minima.empty())
    minima = promising_fits(records, readings, scattered(model, model.starts), setting, wide_search);
  if (!minima.empty()) return minima;
  refuse(
      records.front().axis, records.front().name,
      fmt::format("no starting point of the friction model {} can be simulated along the records, the rotor "
                  "is too fast for their sampling; are the units right?",
                  friction::traits_of(model.law).word));
}

/// The fit of the law to all readings, started from `minima` (results of short fits). The time offset is free
/// only in the last steps, because far from a minimum it would compensate for a wrong inertia.
/// @param least_squares smallest sum of squares of the laws fitted before
FitResult fit_all_readings(Records records, const FitModel& model, const Observations& readings,
                           std::vector<FitResult> minima, double least_squares) {
  const FitSetting setting = setting_of(model);
  const FitSetting undelayed = without_time_offset(setting);
  if (minima.front().squares > hopeless * least_squares) {
    return fit_from(records, readings, minima.front().point, with_steps(setting, hopeless_steps));
  }
  FitResult found = minima.front();
  minima = follow_best(records, readings, std::move(minima), undelayed, {{3, 20}, {1, last_steps}});
  if (!minima.empty()) found = minima.front();
  const FitResult delayed = fit_from(records, readings, found.point, with_steps(setting, last_steps));
  return std::isfinite(delayed.squares) ? delayed : found;
}

/// The fit to observations with independent errors (observe()), starting from a fit to all readings. If that
/// fit leaves residuals above the rounding of the readings, it is returned unchanged: the law causes them,
/// and observations would take most of the time.
/// @param rough the fit to all readings
LawFit refined(Records records, const FitModel& model, const FitResult& rough) {
  LawFit fit;
  fit.setting = setting_of(model);
  fit.squares = rough.squares;
  fit.converged = rough.converged;
  observe_at(records, rough.point, fit);
  bool explained = true;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd& path = fit.model.motions[r].path;
    explained = explained && is_explained(records[r], path);
    const Eigen::VectorXd left = residuals_along(records[r], path);
    std::vector<double>& used = fit.residuals.emplace_back();
    for (std::size_t k = 0; k < sample_count(records[r]); ++k) {
      if (!is_excluded(records[r], k)) used.push_back(left[static_cast<Eigen::Index>(k)]);
    }
  }
  constexpr int rounds = 3;
  constexpr int steps = 15;
  for (int round = 0; explained && round < rounds; ++round) {
    const FitResult finer =
        fit_from(records, fit.observations, fit.model.point, with_steps(fit.setting, steps));
    if (!std::isfinite(finer.squares)) break;
    observe_at(records, finer.point, fit);
  }
  fit.setting.prior = fit.model.point.axis;
  return fit;
}

}  // namespace

LawFit fit_law(Records records, const FitModel& model, double least_squares) {
  const Observations readings = all_readings(records);
  std::vector<FitResult> minima =
      first_minima(records, model, readings, without_time_offset(setting_of(model)));
  return refined(records, model,
                 fit_all_readings(records, model, readings, std::move(minima), least_squares));
}

LawFit search_again(Records records, const FitModel& model, double least_squares, LawFit found) {
  const Observations readings = all_readings(records);
  const FitSetting setting = without_time_offset(setting_of(model));
  std::vector<FitResult> minima;
  for (const std::vector<Point>& centres : {std::vector{found.model.point.axis}, model.starts}) {
    for (const FitResult& fit :
         promising_fits(records, readings, scattered(model, centres), setting, wide_search))
      minima.push_back(fit);
  }
  std::ranges::sort(minima, {}, &FitResult::squares);
  if (minima.empty() || minima.front().squares > hopeless * least_squares) return found;
  const FitResult best = fit_all_readings(records, model, readings, std::move(minima), least_squares);
  return best.squares < found.squares ? refined(records, model, best) : std::move(found);
}

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

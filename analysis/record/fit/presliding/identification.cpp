#include "analysis/record/fit/presliding/identification.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/presliding/contact_fit.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::fit {
namespace {

constexpr std::size_t min_reversals = 2;

/// Largest half-width (of a logarithm) that an interval may have after it was widened because the model does
/// not fit.
constexpr double widest_widened = 7.0;  // a factor of 1000 to each side

/// Half-width (of a logarithm) above which the interval is computed by profile likelihood.
constexpr double max_linear_halfwidth = 0.05;

bool is_known(const IdentificationOptions& options, Coordinate coordinate) {
  return std::any_of(options.known.begin(), options.known.end(),
                     [&](const KnownParameter& known) { return known.coordinate == coordinate; });
}

void check_reversals(Records records, const IdentificationOptions& options) {
  if (is_known(options, log_k1) && is_known(options, log_k2) && is_known(options, log_beta)) return;
  std::size_t reversals = 0;
  for (const TestRecord& record : records) reversals += record.parts.reversals();
  if (reversals >= min_reversals) return;
  throw Failure(ExitCode::bad_data,
                fmt::format("too few reversals: the {} {} (changes below 2 % of its range do not count); "
                            "expected at least {} reversals: a loading, an unloading and a reloading",
                            parameters::text_on(records.front().axis, "$torque"),
                            reversals == 0 ? "never reverses" : "reverses once", min_reversals));
}

bool is_same(const motion::TorqueCourse& one, const motion::TorqueCourse& other) {
  return one.now == other.now && one.settled == other.settled && one.rate == other.rate;
}

RecordSummary summary_of(Records records, const ContactFit& fit, std::size_t number) {
  const TestRecord& record = records[number];
  RecordSummary summary{extent_of(record)};
  summary.duration = static_cast<double>(summary.samples) * record.sample_time;
  summary.counted = record.counted;
  summary.unit = record.unit;
  summary.branches = record.parts.branches.size();
  summary.reversals = record.parts.reversals();
  summary.holds = record.parts.holds.size();
  summary.ring_downs = record.parts.ring_downs();
  summary.misfit = misfit_of(records, fit, number);
  summary.noise = fit.noise[number];
  return summary;
}

bool is_time_offset(const Quantity& quantity) {
  return coordinate_of(quantity) == time_offset;
}

/// True if the quantity is the sum k1 + k2, the only quantity without a coordinate of its own.
bool is_sum(const Quantity& quantity) {
  return quantity.key.empty() && !is_time_offset(quantity);
}

bool is_open(const Quantity& quantity, const QuantityEstimate& estimate) {
  return !(estimate.half_width() <= max_half_width(quantity.logarithmic));
}

ParameterEstimate parameter_of(const Quantity& quantity, EstimateStatus status,
                               const QuantityEstimate& estimate) {
  return {estimate, quantity.name, quantity.key, quantity.unit, status};
}

ParameterEstimate reported(const Quantity& quantity, const QuantityEstimate& estimate) {
  return parameter_of(quantity, EstimateStatus::estimated, on_parameter_scale(quantity, estimate));
}

ParameterEstimate given(const Quantity& quantity, const IdentificationOptions& options) {
  double value = std::exp(quantity.value);  // of k1 + k2, which has no key
  for (const KnownParameter& known : options.known) {
    if (known.coordinate == coordinate_of(quantity) && !is_sum(quantity)) value = known.value;
  }
  return parameter_of(quantity, EstimateStatus::known, {value, 0.0, value, value});
}

/// The results of a fit from which the estimates of all quantities are computed.
struct Estimation {
  Records records;
  const ContactFit& fit;
  const FitErrors& errors;
  const IdentificationOptions& options;

  /// The estimate of a quantity.
  /// @param jointly the estimated quantities, to which this one is appended, except for k1 + k2
  ParameterEstimate estimate(const Quantity& quantity, std::vector<EstimatedQuantity>& jointly) const {
    const Coordinate coordinate = coordinate_of(quantity);
    if (is_sum(quantity) ? is_known(options, log_k1) && is_known(options, log_k2)
                         : is_known(options, coordinate)) {
      return given(quantity, options);
    }
    if (!fit.setting.free[coordinate]) return kept(quantity);
    const double widening = errors.checks.widening;
    const QuantityEstimate found = interval_of_errors(quantity, errors.errors, widening);
    // A lack of fit does not change which parameters the records determine, so this interval is not widened.
    const QuantityEstimate unwidened = interval_of_errors(quantity, errors.errors, 1.0);
    if (is_open(quantity, unwidened)) return open(quantity);
    const bool has_profile = !quantity.key.empty();
    if (has_profile && unwidened.half_width() > max_linear_halfwidth) {
      const QuantityEstimate profiled = interval_by_profile(records, fit, quantity, found);
      if (!is_open(quantity, profiled)) {
        jointly.push_back({quantity, found, profiled});
        return reported(quantity, profiled);
      }
      if (widening == 1.0) return open(quantity);
    }
    if (quantity.logarithmic && found.half_width() > widest_widened) return beyond_the_model(quantity);
    if (!is_sum(quantity)) jointly.push_back({quantity, found, found});
    return reported(quantity, found);
  }

  /// The estimate of a quantity that the readings would determine if the model fitted, but which is not
  /// identifiable because it does not.
  ParameterEstimate beyond_the_model(const Quantity& quantity) const {
    ParameterEstimate parameter = open(quantity);
    parameter.reason =
        "the model departs systematically from the records, and the interval that allows for it spans more "
        "than a factor of a thousand to each side";
    return parameter;
  }

  /// The estimate of the time offset if it was kept fixed. It is the only coordinate that an identification
  /// fixes by itself.
  ParameterEstimate kept(const Quantity& quantity) const {
    ParameterEstimate parameter =
        parameter_of(quantity, EstimateStatus::kept, {quantity.value, 0.0, quantity.value, quantity.value});
    parameter.reason = missing_information(records, fit, time_offset);
    return parameter;
  }

  ParameterEstimate open(const Quantity& quantity) const {
    ParameterEstimate parameter = parameter_of(quantity, EstimateStatus::not_identifiable, {});
    // λ is known as well as n is.
    const Coordinate missing =
        coordinate_of(quantity) == log_limit ? creep_exponent : coordinate_of(quantity);
    leave_open(parameter, missing_information(records, fit, missing));
    return parameter;
  }
};

std::vector<Identification::Correlation> strong_correlations(const JointErrors& errors) {
  constexpr double strong = 0.9;
  std::vector<Identification::Correlation> correlations;
  for (Eigen::Index i = 0; i < errors.covariance.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < errors.covariance.cols(); ++j) {
      const double value = errors.correlation(i, j);
      if (std::abs(value) < strong) continue;
      correlations.push_back(
          {errors.names[static_cast<std::size_t>(i)], errors.names[static_cast<std::size_t>(j)], value});
    }
  }
  return correlations;
}

/// True if the interval of the time offset is too wide for the fit to determine it.
bool shows_no_time_offset(const ContactFit& fit, const FitErrors& errors) {
  const Quantity offset = time_offset_quantity(fit.model.point.axis);
  return is_open(offset, interval_of_errors(offset, errors.errors, 1.0));
}

/// Draws the estimated parameters jointly, for a manifest. Fits beyond the limit n ≥ 1 are replaced by more
/// replicates; a tenth of valid ones is enough.
JointDraws draw_jointly(const Estimation& from, std::vector<EstimatedQuantity> estimated) {
  std::erase_if(estimated, [](const EstimatedQuantity& one) { return is_time_offset(one.quantity); });
  JointDraws draws;
  for (const EstimatedQuantity& one : estimated) draws.keys.push_back(one.quantity.key);
  if (estimated.empty()) return draws;
  constexpr std::size_t max_blocks = 10;
  const std::size_t wanted = from.options.draws;
  for (std::size_t block = 0; block < max_blocks && draws.rows.size() < wanted; ++block) {
    const ReadingReplicates more = replicate_readings(from.records, from.fit, wanted, block * wanted);
    append_draws(estimated, more.errors, from.errors.checks.widening, wanted, draws);
  }
  return draws;
}

/// A fit, with the standard errors of its parameters from replicates of the readings, and the checks of its
/// residuals.
struct CheckedFit {
  ContactFit fit;
  FitErrors errors;
};

CheckedFit checked_fit(Records records, ContactFit fit, const IdentificationOptions& options) {
  if (options.report) options.report("replicates of the readings");
  FitErrors errors = errors_of(records, fit, options.replicates);
  return {std::move(fit), std::move(errors)};
}

/// Fits the contact, and repeats the fit in other ways until encoder resolution and noise explain the
/// residuals, or no way is left.
CheckedFit explained_fit(Records records, const IdentificationOptions& options) {
  const auto enter = [&](std::string_view stage) {
    if (options.report) options.report(stage);
  };
  CheckedFit best =
      checked_fit(records, fit_contact(records, options.known, options.report, options.effort), options);
  if (best.fit.setting.free[time_offset] && shows_no_time_offset(best.fit, best.errors)) {
    enter("fit with the given delay");
    keep_time_offset(records, best.fit);
    best = checked_fit(records, std::move(best.fit), options);
  }
  if (best.errors.checks.passed) return best;
  enter("fit with other values of beta");
  if (improve_softening(records, best.fit)) best = checked_fit(records, std::move(best.fit), options);
  return best;
}

/// Frequencies of the fitted rotor's free oscillation, Hz: of large oscillations on the stiffness k1 (low),
/// of small ones on k1 + k2 (high).
FrequencyRange own_ringing_of(const ContactFit& fit) {
  const ContactParameters contact = contact_at(fit.model.point.axis, fit.creep_torque);
  const auto frequency = [&](double stiffness) {
    return std::sqrt(stiffness / contact.plant.inertia) / (2.0 * std::numbers::pi);
  };
  return {frequency(contact.friction.k1), frequency(contact.friction.k1 + contact.friction.k2)};
}

std::optional<ResidualLine> line_beside(Records records, const ContactFit& fit, const FrequencyRange& own) {
  constexpr double margin = 1.2;  // the frequency of a misfitted ring-down is not quite the model's
  return residual_line(records, fit.model, fit.noise, {own.low / margin, own.high * margin});
}

}  // namespace

void check_different(Records records) {
  for (const TestRecord& record : records) {
    if (record.axis == records.front().axis) continue;
    throw Failure(
        ExitCode::bad_input,
        fmt::format(
            "{}: its axis is of another kind than that of {}; expected records of one axis, rotary or linear",
            record.name, records.front().name));
  }
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const TestRecord& one = records[j];
      const TestRecord& other = records[i];
      if (one.reading != other.reading ||
          !std::equal(one.torque.begin(), one.torque.end(), other.torque.begin(), is_same)) {
        continue;
      }
      refuse(
          other.axis, other.name,
          fmt::format("is the same record as {}, equal in every sample; expected records of different tests",
                      one.name));
    }
  }
}

Identification identify(std::vector<TestRecord> records, const IdentificationOptions& options) {
  check_different(records);
  for (TestRecord& record : records) record.parts = parts_of(record);
  check_reversals(records, options);
  const auto enter = [&](std::string_view stage) {
    if (options.report) options.report(stage);
  };
  Identification result;
  const auto [fit, errors] = explained_fit(records, options);
  const ResidualChecks& checks = errors.checks;
  result.checks = checks;
  result.effort = fit.effort;
  result.search_ended = !checks.passed && has_ended_early(fit);
  for (std::size_t r = 0; r < records.size(); ++r) {
    result.records.push_back(summary_of(records, fit, r));
    result.fitted.push_back(fitted_record(records[r], fit.model.motions[r].path));
  }
  result.own_ringing = own_ringing_of(fit);
  if (!checks.passed) {
    enter("spectrum of the residuals");
    result.residual_line = line_beside(records, fit, result.own_ringing);
  }
  refuse_gross_misfit(records, fit, checks, second_mass_text(result));
  const std::vector<Quantity> quantities = fit.setting.model.quantities_at(fit.model.point.axis);
  const Estimation estimation{records, fit, errors, options};
  std::vector<EstimatedQuantity> estimated;
  for (const Quantity& quantity : quantities) {
    enter(fmt::format("interval of {}", quantity.name));
    result.parameters.push_back(estimation.estimate(quantity, estimated));
  }
  result.axis = records.front().axis;
  for (ParameterEstimate& one : result.parameters) one.unit = parameters::unit_on(result.axis, one.unit);
  result.sample_time = records.front().sample_time;
  result.errors = joint_errors(estimated, errors.errors, checks.widening);
  result.correlations = strong_correlations(result.errors);
  if (options.draws > 0) {
    enter("joint draws");
    result.draws = draw_jointly(estimation, std::move(estimated));
  }
  result.fragment = manifest_fragment(result);
  return result;
}

}  // namespace zerocount::fit

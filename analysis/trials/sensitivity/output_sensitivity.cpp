#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/trials/sensitivity/correlations.hpp"
#include "analysis/trials/sensitivity/sensitivity.hpp"
#include "analysis/trials/sensitivity/sobol_indices.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::sensitivity {
namespace {

constexpr std::size_t min_rows = 10;
constexpr std::int64_t min_of_a_kind = 10;

/// Indices of the trials of a design point from which the sensitivity of an output is estimated. Only trials
/// with a value of the output are used; in a saltelli design, only rows in which all trials have one.
struct UsedTrials {
  /// Index of the first trial of each used row of a saltelli design (a row has one trial of A, one of B and
  /// one for each factor).
  std::vector<std::size_t> row_starts;
  /// Indices of the independent trials: all trials, or those of the matrices A and B in a saltelli design.
  std::vector<std::size_t> independent;
  /// Number of trials left out because they, or another trial in their row of a saltelli design, have no
  /// value.
  std::int64_t left_out{0};
  /// Number of trials that are not used because an earlier trial ran on the same machine.
  std::int64_t of_machines{0};
};

/// Selects the trials from which the sensitivity is estimated.
/// @param values [trial] value of the output; NaN if the trial has none
UsedTrials used_trials(const PointInputs& point, const std::vector<double>& values) {
  UsedTrials used;
  if (point.design != study::Design::saltelli) {
    const std::size_t looked_at =
        point.machines > 0 ? static_cast<std::size_t>(point.machines) : values.size();
    for (std::size_t i = 0; i < looked_at; ++i) {
      if (std::isfinite(values[i])) used.independent.push_back(i);
    }
    used.of_machines = point.machines > 0 ? static_cast<std::int64_t>(values.size() - looked_at) : 0;
    used.left_out = static_cast<std::int64_t>(looked_at - used.independent.size());
    return used;
  }
  const std::size_t length = designs::saltelli_row_length(point.factors.size());
  for (std::size_t start = 0; start + length <= values.size(); start += length) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(start);
    if (!std::all_of(first, first + static_cast<std::ptrdiff_t>(length),
                     [](double v) { return std::isfinite(v); })) {
      used.left_out += static_cast<std::int64_t>(length);
      continue;
    }
    used.row_starts.push_back(start);
    used.independent.insert(used.independent.end(), {start, start + 1});
  }
  return used;
}

/// The elements of `values` at the indices `places`.
std::vector<double> picked(const std::vector<double>& values, const std::vector<std::size_t>& places) {
  std::vector<double> result;
  result.reserve(places.size());
  for (const std::size_t place : places) result.push_back(values[place]);
  return result;
}

/// The outputs of the used rows of a saltelli design, sorted by matrix (A, B and one for each factor).
SaltelliSample saltelli_sample(const PointInputs& point, const std::vector<double>& values,
                               const UsedTrials& used) {
  SaltelliSample sample;
  sample.c.resize(point.factors.size());
  for (const std::size_t start : used.row_starts) {
    sample.a.push_back(values[start]);
    sample.b.push_back(values[start + 1]);
    for (std::size_t j = 0; j < sample.c.size(); ++j) sample.c[j].push_back(values[start + 2 + j]);
  }
  return sample;
}

// The inputs that vary among the trials used, and the factors that none of them is.
struct Varying {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  // [trial used, input]
};

Varying varying_inputs(const PointInputs& point, const UsedTrials& used, OutputSensitivity& result) {
  std::vector<std::vector<double>> columns;
  Varying varying;
  for (const InputValues& input : point.inputs) {
    std::vector<double> values = picked(input.values, used.independent);
    if (is_constant(values)) {
      result.left_out.push_back({input.name, "the same in all trials of the point"});
    } else {
      varying.names.push_back(input.name);
      columns.push_back(std::move(values));
    }
  }
  varying.values.resize(static_cast<Eigen::Index>(used.independent.size()),
                        static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    varying.values.col(static_cast<Eigen::Index>(j)) =
        Eigen::VectorXd::Map(columns[j].data(), varying.values.rows());
  }
  return varying;
}

FactorSensitivity& row_of(OutputSensitivity& result, const std::string& name) {
  const auto found = std::find_if(result.factors.begin(), result.factors.end(),
                                  [&](const FactorSensitivity& factor) { return factor.name == name; });
  if (found != result.factors.end()) return *found;
  result.factors.emplace_back().name = name;
  return result.factors.back();
}

// Names the factors of which the bounds leave more than half of what is possible open.
// @returns whether there are any
bool note_open(OutputSensitivity& result, BoundedNumber FactorSensitivity::*index, std::string_view name) {
  std::vector<std::string> open;
  for (const FactorSensitivity& factor : result.factors)
    if ((factor.*index).high - (factor.*index).low > 0.5) open.push_back(factor.name);
  if (open.empty()) return false;
  result.notes.push_back(fmt::format(
      "there are too few trials to say how large the influence is: the bounds of {} are wider than "
      "0.5 for {}",
      name, fmt::join(open, ", ")));
  return true;
}

void note_uncertain_totals(OutputSensitivity& result) {
  const bool unbounded = std::ranges::any_of(result.factors, [](const FactorSensitivity& factor) {
    return std::isnan(factor.total.low) && !std::isnan(factor.total.value);
  });
  if (unbounded)
    result.notes.push_back(fmt::format(
        "the variance of {} comes from fewer than twenty trials: the Sobol' indices have no bounds",
        result.output));
  note_open(result, &FactorSensitivity::total, "total");
}

void note_uncertain_first_orders(const std::vector<double>& y, OutputSensitivity& result) {
  constexpr double few = 30.0;
  if (!note_open(result, &FactorSensitivity::first_order, "first order")) return;
  const double carrying = values_behind_variance(y);
  if (carrying < few)
    result.notes.push_back(fmt::format("most of the variance of {} comes from about {:.0f} of the {} trials",
                                       result.output, std::ceil(carrying), y.size()));
}

void add_design_indices(const PointInputs& point, const std::vector<double>& values, const UsedTrials& used,
                        double confidence, const random::RandomStream& bootstrap, OutputSensitivity& result) {
  if (used.row_starts.size() < min_rows) {
    result.notes.push_back(fmt::format("{} rows of the design: Sobol' indices need {} at least",
                                       used.row_starts.size(), min_rows));
    return;
  }
  const std::vector<SobolIndices> indices =
      saltelli_indices(saltelli_sample(point, values, used), confidence, bootstrap);
  for (std::size_t j = 0; j < indices.size(); ++j) {
    const std::string& name = point.factors[j];
    const bool constant = std::any_of(result.left_out.begin(), result.left_out.end(),
                                      [&](const FactorLeftOut& left_out) { return left_out.name == name; });
    if (constant) continue;
    FactorSensitivity& factor = row_of(result, name);
    factor.first_order = indices[j].first_order;
    factor.total = indices[j].total;
  }
  note_uncertain_totals(result);
}

void add_correlations(const Varying& varying, const std::vector<double>& y, bool first_orders,
                      double confidence, OutputSensitivity& result) {
  const std::vector<BoundedNumber> partial = partial_rank_correlations(varying.values, y, confidence);
  std::vector<FactorSensitivity> found(varying.names.size());
  parallel::for_each_index(found.size(), [&](std::size_t j) {
    const auto column = varying.values.col(static_cast<Eigen::Index>(j));
    const std::span<const double> x(column.data(), y.size());
    found[j].rank_correlation = rank_correlation(x, y, confidence);
    if (first_orders) found[j].first_order = given_data_first_order(x, y, confidence);
  });
  for (std::size_t j = 0; j < found.size(); ++j) {
    FactorSensitivity& factor = row_of(result, varying.names[j]);
    factor.rank_correlation = found[j].rank_correlation;
    factor.partial_rank_correlation = partial[j];
    if (first_orders) factor.first_order = found[j].first_order;
  }
}

void add_log_odds(const Varying& varying, const std::vector<double>& y, double confidence,
                  OutputSensitivity& result) {
  const Eigen::VectorXd yes = Eigen::VectorXd::Map(y.data(), static_cast<Eigen::Index>(y.size()));
  const LogisticFit fit = logistic_fit(varying.values, yes, confidence);
  for (std::size_t j = 0; j < varying.names.size(); ++j) {
    row_of(result, varying.names[j]).log_odds = fit.slopes[j];
  }
  if (fit.status == LogisticFit::Status::separated) {
    result.notes.emplace_back(
        "a combination of the factors separates the trials with the result yes from those with the result "
        "no: a logistic fit has no finite coefficients");
  }
  const auto said_yes = static_cast<std::int64_t>(std::llround(yes.sum()));
  const std::int64_t fewer = std::min(said_yes, static_cast<std::int64_t>(y.size()) - said_yes);
  if (fewer < min_of_a_kind) {
    result.notes.push_back(
        fmt::format("only {} of {} trials differ from the others: the bounds are rough", fewer, y.size()));
  }
}

void add_notes(const PointInputs& point, const SensitivityOutput& output, const TrialOutputs& trials,
               const UsedTrials& used, OutputSensitivity& result) {
  const std::size_t all = trials.values.size();
  if (used.left_out > 0) {
    result.notes.push_back(
        fmt::format("{} of {} trials are left out{}: some trials have no value, because their "
                    "motion was lost, was stopped, or is not in the file",
                    used.left_out, all - static_cast<std::size_t>(used.of_machines),
                    point.design == study::Design::saltelli ? ", in whole rows" : ""));
  }
  if (point.correlated) {
    result.notes.emplace_back(
        "some parameters are correlated: an index contains what a parameter shares with the others, and the "
        "indices of correlated parameters may exceed 1 in all");
  }
  if (point.subject == Subject::trials_in_worlds) {
    result.notes.emplace_back(
        "within worlds: what differs between worlds adds to the variance that nothing here explains");
  }
  if (used.of_machines > 0) {
    result.notes.push_back(fmt::format(
        "only the first trial of each of the {} machines is used: the others are not independent of it",
        point.machines));
  }
  if (trials.late > 0) {
    result.notes.push_back(fmt::format("{} of {} trials have a move that {}; it counts with its duration",
                                       trials.late, all, output.never));
  }
  if (point.design == study::Design::latin_hypercube || point.design == study::Design::sobol) {
    result.notes.emplace_back(
        "the bounds are those of independent trials; with this design they are, as a rule, too wide");
  }
}

// The strongest first: by total indices; without a saltelli design those that explain some variance alone, by
// its proportion, and then the others by their partial rank correlation.
bool is_stronger(const FactorSensitivity& a, const FactorSensitivity& b, bool from_saltelli) {
  const auto key = [&](const FactorSensitivity& factor) {
    const double proportion = from_saltelli ? factor.total.value : factor.first_order.value;
    const bool counts = from_saltelli ? !std::isnan(proportion) : factor.first_order.low > relevant_index;
    const double correlation = std::abs(factor.partial_rank_correlation.value);
    return std::pair(counts ? proportion : -1.0, std::isnan(correlation) ? -1.0 : correlation);
  };
  return key(a) > key(b);
}

void rank_factors(bool from_saltelli, OutputSensitivity& result) {
  for (FactorSensitivity& factor : result.factors) {
    factor.matters = from_saltelli
                         ? factor.total.low > relevant_index
                         : factor.first_order.low > relevant_index ||
                               excludes_up_to(relevant_correlation, factor.partial_rank_correlation);
  }
  std::stable_sort(result.factors.begin(), result.factors.end(),
                   [&](const FactorSensitivity& a, const FactorSensitivity& b) {
                     return is_stronger(a, b, from_saltelli);
                   });
  result.estimated = std::any_of(result.factors.begin(), result.factors.end(), [](const auto& factor) {
    return !std::isnan(factor.first_order.value) || !std::isnan(factor.rank_correlation.value);
  });
}

void describe_sample(const std::vector<double>& y, OutputSensitivity& result) {
  statistics::Moments moments;
  for (const double value : y) moments.add(value);
  result.mean = moments.mean;
  result.standard_deviation = moments.sd();
}

}  // namespace

OutputSensitivity output_sensitivity(const PointInputs& inputs, const SensitivityOutput& output,
                                     const TrialOutputs& trials, double confidence,
                                     const random::RandomStream& bootstrap) {
  OutputSensitivity result;
  result.output = output.name;
  result.unit = output.unit;
  result.meaning = output.meaning;
  const bool from_saltelli = inputs.design == study::Design::saltelli;
  const UsedTrials used = used_trials(inputs, trials.values);
  const std::vector<double> y = picked(trials.values, used.independent);
  result.trials = static_cast<std::int64_t>(trials.values.size()) - used.left_out - used.of_machines;
  describe_sample(y, result);
  add_notes(inputs, output, trials, used, result);
  if (!y.empty() && !is_constant(y)) {
    const Varying varying = varying_inputs(inputs, used, result);
    if (from_saltelli) add_design_indices(inputs, trials.values, used, confidence, bootstrap, result);
    add_correlations(varying, y, !from_saltelli, confidence, result);
    if (!from_saltelli) note_uncertain_first_orders(y, result);
    if (output.yes_or_no && inputs.subject != Subject::worlds) add_log_odds(varying, y, confidence, result);
    rank_factors(from_saltelli, result);
  }
  result.conclusion = sensitivity_conclusion(result, from_saltelli, confidence, inputs.subject);
  return result;
}

}  // namespace zerocount::sensitivity

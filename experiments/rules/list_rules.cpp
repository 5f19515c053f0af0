#include <cmath>

#include <fmt/format.h>

#include "core/friction/friction_model.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"

namespace zerocount::rules {
namespace {

using Faults = std::vector<ValueFault>;

// The values of a list that the study has.
std::vector<parameter::Handle> values_of_list(const study::StudyTable& table, parameter::Handle list) {
  const auto values = study::find_list(table, parameters::find_parameter(list).value());
  std::vector<parameter::Handle> found;
  for (std::size_t i = 0; values && i < values->count; ++i)
    found.emplace_back(table.rows[values->first + i].name);
  return found;
}

ValueRule weights_of_one_in_all(const std::vector<parameter::Handle>& weights) {
  return between(weights, [](const Ranges& of) -> Faults {
    constexpr double rounding = 1e-9;
    double lowest = 0.0;
    double highest = 0.0;
    for (const study::ParameterRange& weight : of.all()) {
      lowest += weight.low;
      highest += weight.high;
    }
    if (std::abs(lowest - 1.0) <= rounding && std::abs(highest - 1.0) <= rounding) return {};
    return {{lowest == highest
                 ? fmt::format("the weights sum to {:.6g}", lowest)
                 : fmt::format("the sum of the weights can be {:.6g} to {:.6g}", lowest, highest),
             "weights that sum to 1 in every trial"}};
  });
}

// The default elements are stiffnesses of a rotary axis.
ValueRule elements_of_linear_axis() {
  return between({parameter::friction::model}, [](const Ranges& of) -> Faults {
    const study::ParameterRange& model = of[parameter::friction::model];
    if (model.low != static_cast<double>(friction::FrictionModel::gms)) return {};
    return {{"gms has no default elements on a linear axis",
             "the lists friction.gms.stiffness, N/m, and friction.gms.weight"}};
  });
}

std::vector<ValueRule> rules_of_gms(const study::StudyTable& table, const parameters::StudyUnits& units) {
  const std::vector<parameter::Handle> stiffnesses =
      values_of_list(table, parameter::friction::gms::stiffness);
  const std::vector<parameter::Handle> weights = values_of_list(table, parameter::friction::gms::weight);
  if (units.axis == parameters::AxisKind::linear && stiffnesses.empty() && weights.empty())
    return {elements_of_linear_axis()};
  std::vector<ValueRule> rules;
  if (!weights.empty()) rules.push_back(weights_of_one_in_all(weights));
  if (stiffnesses.size() != weights.size()) {
    const std::size_t n = stiffnesses.size();
    const std::size_t m = weights.size();
    rules.push_back(between({n > 0 ? stiffnesses.front() : weights.front()}, [n, m](const Ranges&) -> Faults {
      return {{fmt::format("{} stiffnesses but {} weights of the elements", n, m),
               "friction.gms.stiffness and friction.gms.weight of equal length"}};
    }));
  }
  return rules;
}

// The bilinear transform maps frequencies below half the sample rate.
ValueRule frequency_of_filter(parameter::Handle frequency) {
  return between({frequency, parameter::controller::sample_rate}, [frequency](const Ranges& of) -> Faults {
    const study::ParameterRange& of_filter = of[frequency];
    const study::ParameterRange& rate = of[parameter::controller::sample_rate];
    if (of_filter.high < 0.5 * rate.low) return {};
    return {{fmt::format("a frequency of {} Hz can reach half the sample rate of {} Hz", of_filter.high,
                         rate.low),
             "less than half of controller.sample_rate"}};
  });
}

bool is_frequency_of_filter(const parameters::Parameter& row) {
  if (!row.name.ends_with(".frequency") || !parameters::has_value(row)) return false;
  const std::string pattern = parameters::without_indices(row.name);
  return pattern != row.name && pattern.ends_with(".filters.#.frequency");
}

}  // namespace

std::vector<ValueRule> plugin_rules(const study::StudyPlan& plan) {
  if (!plan.plugin) return {};
  return {between({parameter::controller::coarse::coarse_beyond}, [](const Ranges& of) -> Faults {
    const study::ParameterRange& beyond = of[parameter::controller::coarse::coarse_beyond];
    if (!study::can_have_coarse_phase(beyond)) return {};
    return {{"a plugin has no phases", "none with controller.plugin"}};
  })};
}

std::vector<ValueRule> list_rules(const study::StudyPlan& plan) {
  std::vector<ValueRule> rules = rules_of_gms(plan.table, plan.units);
  for (const parameters::Parameter& row : plan.table.rows) {
    if (is_frequency_of_filter(row)) rules.push_back(frequency_of_filter(parameter::Handle(row.name)));
  }
  return rules;
}

}  // namespace zerocount::rules

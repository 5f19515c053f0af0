#include <cstddef>
#include <variant>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {
namespace {

constexpr double tail_probability = 0.001;

/// Whether the distribution reaches down to very improbable low values: the normal, truncated normal and
/// lognormal distributions.
struct HasLowTail {
  bool operator()(const distributions::Uniform&) const { return false; }
  bool operator()(const distributions::LogUniform&) const { return false; }
  bool operator()(const distributions::Normal&) const { return true; }
  bool operator()(const distributions::TruncatedNormal&) const { return true; }
  bool operator()(const distributions::Lognormal&) const { return true; }
  bool operator()(const distributions::Triangular&) const { return false; }
  bool operator()(const distributions::Integers&) const { return false; }
  bool operator()(const distributions::Choice&) const { return false; }
};

LowEnd low_end_of(const distributions::Distribution& distribution) {
  if (std::visit(HasLowTail{}, distribution))
    return {LowEnd::Kind::tail, distributions::quantile(distribution, tail_probability)};
  return {LowEnd::Kind::support, distributions::support(distribution).low};
}

LowEnd low_end_of_slot(const StudyPlan& plan, std::size_t point, std::size_t slot);

/// The low end of a value at the age of a point, computed from its low end at age 0 and the low end of its
/// rate of aging.
LowEnd at_age(const StudyPlan& plan, std::size_t point, const Value& value, LowEnd end) {
  if (!value.aging) return end;
  const Aging& aging = plan.agings[*value.aging];
  const LowEnd rate = low_end_of_slot(plan, point, aging.rate);
  end.value *= factor_at_age(aging, rate.value, age_at(plan, point));
  if (end.kind == LowEnd::Kind::number) end.kind = rate.kind;
  return end;
}

LowEnd low_end_of_slot(const StudyPlan& plan, std::size_t point, std::size_t slot) {
  const Value& value = *value_at_point(plan, slot, point);
  switch (value.kind) {
    case Value::Kind::number:
      return at_age(plan, point, value, {LowEnd::Kind::number, value.number});
    case Value::Kind::distribution:
      return at_age(plan, point, value, low_end_of(plan.distributions[value.index]));
    case Value::Kind::derived:
      if (const DerivedValue& derived = plan.derived[value.index]; derived.value == nullptr)
        return low_end_of_slot(plan, point, derived.from.front());
      return {LowEnd::Kind::support, range_of_slot(plan, slot, point).low};
    case Value::Kind::profile:
      break;
  }
  return {LowEnd::Kind::profile, 0.0};
}

}  // namespace

LowEnd low_end(const Study& study, std::int64_t point, std::string_view parameter, std::int64_t setting) {
  return low_end_of_slot(*study.plan, plan_point(*study.plan, point, setting),
                         parameters::find_parameter(parameter).value());
}

}  // namespace zerocount::study

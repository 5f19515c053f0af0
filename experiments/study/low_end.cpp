#include "experiments/study/low_end.hpp"

#include <cstddef>
#include <variant>

#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/plan.hpp"

namespace zerocount {
namespace {

constexpr double tail_probability = 0.001;

/// Whether the distribution has a low tail with small probability (the normal distributions).
struct HasLowTail {
  bool operator()(const Uniform&) const { return false; }
  bool operator()(const LogUniform&) const { return false; }
  bool operator()(const Normal&) const { return true; }
  bool operator()(const TruncatedNormal&) const { return true; }
  bool operator()(const Lognormal&) const { return true; }
  bool operator()(const Triangular&) const { return false; }
  bool operator()(const Integers&) const { return false; }
  bool operator()(const Choice&) const { return false; }
};

LowEnd low_end_of(const Distribution& distribution) {
  if (std::visit(HasLowTail{}, distribution))
    return {LowEnd::Kind::tail, quantile(distribution, tail_probability)};
  return {LowEnd::Kind::support, support(distribution).low};
}

}  // namespace

LowEnd low_end(const Study& study, std::int64_t point, std::string_view parameter) {
  const StudyPlan& plan = *study.plan;
  const Value& value =
      *value_at_point(plan, find_parameter(parameter).value(), static_cast<std::size_t>(point));
  switch (value.kind) {
    case Value::Kind::number:
      return {LowEnd::Kind::number, value.number};
    case Value::Kind::distribution:
      return low_end_of(plan.distributions[value.index]);
    case Value::Kind::profile:
      break;
  }
  return {LowEnd::Kind::profile, 0.0};
}

}  // namespace zerocount

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "experiments/distributions/distribution_forms.hpp"

namespace zerocount::distributions {
namespace {

// The only entry of the map, which names a distribution.
std::optional<Distribution> read_drawn_mean(const yaml::Field& field, yaml::Problems& problems) {
  const std::string expected = fmt::format("a number, or a map with one of {}", distribution_names());
  const auto& entries = field.node->entries;
  if (entries.size() != 1) {
    const bool per = yaml::find_field(field, "per").has_value();
    problems.add(field,
                 per ? "the mean is drawn as often as the profile"
                     : fmt::format("found a map with {} keys", entries.size()),
                 per ? "per beside profile" : expected);
    return std::nullopt;
  }
  const DistributionForm* form = find_form(field, entries.front(), {}, expected, problems);
  if (form == nullptr) return std::nullopt;
  if (form->name == interval_name) {
    problems.add(field, "an interval is drawn for each world, and the mean as often as the profile",
                 "a distribution, such as uniform");
    return std::nullopt;
  }
  auto distribution = read_distribution(*form, yaml::entry_of(field, entries.front()), problems);
  if (!distribution) return std::nullopt;
  if (!numerics::contains(numerics::above(0.0), support(*distribution)) ||
      !extremes_are_inside(*distribution, numerics::above(0.0))) {
    problems.add(field,
                 fmt::format("its values {} are not all positive and finite",
                             numerics::notation(support(*distribution))),
                 "a distribution of numbers greater than 0");
    return std::nullopt;
  }
  return distribution;
}

constexpr std::array<std::string_view, 2> marginals{"normal", "lognormal"};

}  // namespace

const shapes::Shape& profile_shape() {
  using Form = shapes::Shape::Form;
  constexpr const char* shown = "profile: {mean, cv, correlation_length, marginal}";
  static const shapes::Shape shape =
      shapes::of(Form::map, {}, shown,
                 {{"mean", "", shown},
                  shapes::real({.low = 0.0, .high = 10.0, .high_included = true}, {"cv", "", shown}),
                  shapes::real(numerics::above(0.0), {"correlation_length", "", shown}),
                  shapes::of(Form::label, {.name = "marginal", .labels = marginals})});
  return shape;
}

std::optional<ProfileForm> read_profile(const yaml::Field& field, double period, yaml::Problems& problems) {
  const std::size_t before = problems.size();
  shapes::Shape shape = profile_shape();
  const double scale = period / (2.0 * std::numbers::pi);
  std::ranges::find(shape.parts, "correlation_length", &shapes::Shape::name)->range =
      numerics::closed(scale * min_correlation_length, scale * max_correlation_length);
  shapes::read(field, shape, problems);
  ProfileForm form;
  const auto mean = yaml::find_field(field, "mean");
  if (mean && mean->node->kind == yaml::YamlNode::Kind::map) {
    form.mean = read_drawn_mean(*mean, problems);
  } else if (mean) {
    form.description.mean = yaml::read_real(*mean, numerics::above(0.0), problems).value_or(1.0);
  }
  if (problems.size() != before) return std::nullopt;
  form.description.period = period;
  form.description.cv = shapes::number_of(yaml::find_field(field, "cv").value());
  form.description.correlation_length =
      shapes::number_of(yaml::find_field(field, "correlation_length").value());
  const auto marginal = yaml::find_field(field, "marginal");
  if (marginal && marginal->node->text == marginals[0])
    form.description.marginal = friction::Marginal::normal;
  return form;
}

}  // namespace zerocount::distributions

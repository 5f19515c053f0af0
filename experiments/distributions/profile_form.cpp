#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/parameters/unknown_key.hpp"

namespace zerocount::distributions {
namespace {

constexpr std::string_view profile_shown = "profile: {mean, cv, correlation_length, marginal}";

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

void read_marginal(const yaml::Field& field, ProfileDescription& description, yaml::Problems& problems) {
  const std::string& text = field.node->text;
  description.marginal = text == "normal" ? friction::Marginal::normal : friction::Marginal::lognormal;
  if (text == "normal" || text == "lognormal") return;
  problems.add(field, fmt::format("unknown marginal {}", yaml::in_quotes(yaml::flow_text(*field.node))),
               "normal or lognormal");
}

}  // namespace

std::optional<ProfileForm> read_profile(const yaml::Field& field, double period, yaml::Problems& problems) {
  static const std::vector<std::string> known{"mean", "cv", "correlation_length", "marginal"};
  if (!yaml::check_map(field, std::string(profile_shown), problems)) return std::nullopt;
  const std::size_t before = problems.size();
  ProfileForm form;
  form.description.period = period;
  const auto number = [&](std::string_view key, const numerics::Interval& range, double& to) {
    if (const auto value = yaml::find_field(field, key)) {
      to = yaml::read_real(*value, range, problems).value_or(to);
    } else {
      problems.add(field, fmt::format("{} is missing", key), profile_shown);
    }
  };
  const auto mean = yaml::find_field(field, "mean");
  if (mean && mean->node->kind == yaml::YamlNode::Kind::map) {
    form.mean = read_drawn_mean(*mean, problems);
  } else {
    number("mean", numerics::above(0.0), form.description.mean);
  }
  number("cv", {.low = 0.0, .high = 10.0, .high_included = true}, form.description.cv);
  const double scale = period / (2.0 * std::numbers::pi);
  number("correlation_length",
         numerics::closed(scale * min_correlation_length, scale * max_correlation_length),
         form.description.correlation_length);
  parameters::check_keys(field, known, problems);
  if (const auto marginal = yaml::find_field(field, "marginal"))
    read_marginal(*marginal, form.description, problems);
  if (problems.size() != before) return std::nullopt;
  return form;
}

}  // namespace zerocount::distributions

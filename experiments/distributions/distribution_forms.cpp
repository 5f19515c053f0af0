#include "experiments/distributions/distribution_forms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/yaml/problems.hpp"

namespace zerocount::distributions {
namespace {

using shapes::Shape;
using Form = Shape::Form;
using Numbers = std::vector<double>;

// Up to this limit a double represents whole numbers exactly.
constexpr std::int64_t max_whole_number = std::int64_t{1} << 53;

// A list, or a map, of real numbers with these names.
Shape numbers(Form form, std::string_view name, const std::vector<std::string_view>& keys) {
  const std::string shown = fmt::format("{}", fmt::join(keys, ", "));
  std::vector<Shape> parts;
  for (const std::string_view key : keys)
    parts.push_back(shapes::real(numerics::all_numbers(), {key, "", "a number"}));
  return shapes::of(form, {},
                    fmt::format("{}: {}", name, form == Form::map ? "{" + shown + "}" : "[" + shown + "]"),
                    std::move(parts));
}

template <class Kind, std::size_t... index>
Distribution make(const Numbers& numbers) {
  return Kind{numbers[index]...};
}

Distribution make_integers(const Numbers& n) {
  return Integers{static_cast<std::int64_t>(n[0]), static_cast<std::int64_t>(n[1])};
}

Distribution make_choice(const Numbers& n) {
  return Choice{n};
}

std::vector<DistributionForm> make_forms() {
  using enum Form;
  const auto with = [](std::string_view name, Form form, const std::vector<std::string_view>& keys,
                       std::string_view meaning, Distribution (*make)(const Numbers&)) {
    return DistributionForm{name, numbers(form, name, keys), meaning, make};
  };
  const Shape whole = shapes::whole(-max_whole_number, max_whole_number);
  return {
      with("uniform", tuple, {"low", "high"}, "uniform from low to below high", make<Uniform, 0, 1>),
      with("log_uniform", tuple, {"low", "high"}, "the logarithm is uniform; 0 < low",
           make<LogUniform, 0, 1>),
      with("normal", map, {"mean", "sd"}, "Gaussian", make<Normal, 0, 1>),
      with("truncated_normal", map, {"mean", "sd", "low", "high"},
           "Gaussian with this mean and sd, conditioned on low to below high",
           make<TruncatedNormal, 0, 1, 2, 3>),
      with("lognormal", map, {"median", "cv"},
           "the logarithm is Gaussian; cv is the standard deviation over the mean of the variable itself",
           make<Lognormal, 0, 1>),
      with("triangular", tuple, {"low", "mode", "high"},
           "density that rises linearly from low to mode and falls linearly to high",
           make<Triangular, 0, 1, 2>),
      {"integers", shapes::of(tuple, {}, "integers: [low, high]", {whole, whole}),
       "each whole number from low to high, both included, equally likely", make_integers, true},
      {"choice",
       shapes::of(list, {.min_count = 1}, "choice: [value, ...]", {shapes::real(numerics::all_numbers())}),
       "each value of the list equally likely", make_choice},
      with(interval_name, tuple, {"low", "high"},
           "from low to high without a distribution; only per: world, spread evenly over the worlds",
           make<Uniform, 0, 1>),
  };
}

}  // namespace

std::span<const DistributionForm> distribution_forms() {
  static const std::vector<DistributionForm> forms = make_forms();
  return forms;
}

std::string shown_value(const DistributionForm& form) {
  return form.shape.expected.substr(form.name.size() + 2);
}

std::string distribution_names() {
  std::vector<std::string_view> names;
  for (const DistributionForm& form : distribution_forms()) names.push_back(form.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<Distribution> read_distribution(const DistributionForm& form, const yaml::Field& field,
                                              yaml::Problems& problems) {
  if (!shapes::read(field, form.shape, problems)) return std::nullopt;
  Numbers numbers;
  if (form.shape.form == Form::map) {
    for (const Shape& part : form.shape.parts)
      numbers.push_back(shapes::number_of(yaml::find_field(field, part.name).value()));
  }
  for (const yaml::Field& item : shapes::items_of(field)) numbers.push_back(shapes::number_of(item));
  Distribution distribution = form.make(numbers);
  const auto fault = find_fault(distribution);
  if (fault) {
    problems.add(field, fault->what, fault->expected);
    return std::nullopt;
  }
  return distribution;
}

const DistributionForm* find_form(const yaml::Field& map, const yaml::YamlEntry& entry,
                                  const std::vector<std::string>& others, std::string_view expected,
                                  yaml::Problems& problems) {
  std::vector<std::string> names = others;
  for (const DistributionForm& form : distribution_forms()) {
    if (form.name == entry.key) return &form;
    names.emplace_back(form.name);
  }
  problems.add(entry.place, yaml::entry_of(map, entry).path,
               fmt::format("unknown distribution, nearest known: {}", yaml::nearest_name(entry.key, names)),
               expected);
  return nullptr;
}

}  // namespace zerocount::distributions

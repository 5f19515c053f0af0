#include "experiments/distributions/distribution_forms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/parameters/unknown_key.hpp"
#include "experiments/yaml/nearest_name.hpp"

namespace zerocount::distributions {
namespace {

using Numbers = std::vector<double>;

// Up to this limit a double represents whole numbers exactly.
constexpr std::int64_t max_whole_number = std::int64_t{1} << 53;

std::optional<double> read_one(const DistributionForm& form, const yaml::Field& field,
                               yaml::Problems& problems) {
  if (!form.whole_numbers) return yaml::read_real(field, numerics::all_numbers(), problems);
  const auto whole = yaml::read_whole(field, -max_whole_number, max_whole_number, problems);
  if (!whole) return std::nullopt;
  return static_cast<double>(*whole);
}

std::optional<Numbers> read_list(const DistributionForm& form, const yaml::Field& field,
                                 yaml::Problems& problems) {
  const std::string expected = fmt::format("{}: {}", form.name, shown_value(form));
  if (!yaml::check_list(field, expected, problems)) return std::nullopt;
  const std::size_t count = field.node->items.size();
  if (!form.keys.empty() && count != form.keys.size()) {
    problems.add(field, fmt::format("found a list of {}", count), expected);
    return std::nullopt;
  }
  Numbers numbers;
  for (std::size_t i = 0; i < count; ++i) {
    if (const auto number = read_one(form, yaml::item_of(field, i), problems)) numbers.push_back(*number);
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

// The values of `keys` in the map, in their order.
std::optional<Numbers> read_keys(const DistributionForm& form, const yaml::Field& field,
                                 yaml::Problems& problems) {
  const std::string expected = fmt::format("{}: {}", form.name, shown_value(form));
  if (!yaml::check_map(field, expected, problems)) return std::nullopt;
  const std::vector<std::string> known(form.keys.begin(), form.keys.end());
  parameters::check_keys(field, known, problems);
  Numbers numbers;
  for (const std::string& key : known) {
    const auto value = yaml::find_field(field, key);
    if (!value) {
      problems.add(field, fmt::format("{} is missing", key), expected);
    } else if (const auto number = read_one(form, *value, problems)) {
      numbers.push_back(*number);
    }
  }
  if (numbers.size() != known.size()) return std::nullopt;
  return numbers;
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
  using enum DistributionForm::Syntax;
  return {
      {"uniform", list, {"low", "high"}, "uniform from low to below high", make<Uniform, 0, 1>},
      {"log_uniform", list, {"low", "high"}, "the logarithm is uniform; 0 < low", make<LogUniform, 0, 1>},
      {"normal", map, {"mean", "sd"}, "Gaussian", make<Normal, 0, 1>},
      {"truncated_normal",
       map,
       {"mean", "sd", "low", "high"},
       "Gaussian with this mean and sd, conditioned on low to below high",
       make<TruncatedNormal, 0, 1, 2, 3>},
      {"lognormal",
       map,
       {"median", "cv"},
       "the logarithm is Gaussian; cv is the standard deviation over the mean of the variable itself",
       make<Lognormal, 0, 1>},
      {"triangular",
       list,
       {"low", "mode", "high"},
       "density that rises linearly from low to mode and falls linearly to high",
       make<Triangular, 0, 1, 2>},
      {"integers",
       list,
       {"low", "high"},
       "each whole number from low to high, both included, equally likely",
       make_integers,
       true},
      {"choice", list, {}, "each value of the list equally likely", make_choice},
      {interval_name,
       list,
       {"low", "high"},
       "from low to high without a distribution; only per: world, spread evenly over the worlds",
       make<Uniform, 0, 1>},
  };
}

}  // namespace

std::span<const DistributionForm> distribution_forms() {
  static const std::vector<DistributionForm> forms = make_forms();
  return forms;
}

std::string shown_value(const DistributionForm& form) {
  if (form.keys.empty()) return "[value, ...]";
  const std::string keys = fmt::format("{}", fmt::join(form.keys, ", "));
  return form.syntax == DistributionForm::Syntax::map ? "{" + keys + "}" : "[" + keys + "]";
}

std::string distribution_names() {
  std::vector<std::string_view> names;
  for (const DistributionForm& form : distribution_forms()) names.push_back(form.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<Distribution> read_distribution(const DistributionForm& form, const yaml::Field& field,
                                              yaml::Problems& problems) {
  const auto numbers = form.syntax == DistributionForm::Syntax::map ? read_keys(form, field, problems)
                                                                    : read_list(form, field, problems);
  if (!numbers) return std::nullopt;
  Distribution distribution = form.make(*numbers);
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

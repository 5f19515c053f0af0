#include "experiments/distributions/distribution_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/distributions/distribution_faults.hpp"
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
  const std::string expected = fmt::format("{}: {}", form.name, form.shown);
  if (!yaml::check_list(field, expected, problems)) return std::nullopt;
  const std::size_t count = field.node->items.size();
  if (!form.keys.empty() && count != form.keys.size()) {
    problems.add(field.node->place, field.path, fmt::format("a list of {} stands here", count), expected);
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
  const std::string expected = fmt::format("{}: {}", form.name, form.shown);
  if (!yaml::check_map(field, expected, problems)) return std::nullopt;
  const std::vector<std::string> known(form.keys.begin(), form.keys.end());
  for (const yaml::YamlEntry& entry : field.node->entries) {
    if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
      parameters::add_unknown_key(field, entry, known, problems);
    }
  }
  Numbers numbers;
  for (const std::string& key : known) {
    const yaml::YamlEntry* entry = yaml::find_entry(*field.node, key);
    if (entry == nullptr) {
      problems.add(field.node->place, field.path, fmt::format("{} is missing", key), expected);
    } else if (const auto number = read_one(form, yaml::entry_of(field, *entry), problems)) {
      numbers.push_back(*number);
    }
  }
  if (numbers.size() != known.size()) return std::nullopt;
  return numbers;
}

std::vector<DistributionForm> make_forms() {
  return {
      {"uniform",
       "[low, high]",
       {"low", "high"},
       false,
       false,
       "equally likely anywhere from low to below high",
       [](const Numbers& n) -> Distribution {
         return Uniform{n[0], n[1]};
       }},
      {"log_uniform",
       "[low, high]",
       {"low", "high"},
       false,
       false,
       "the logarithm is uniform; 0 < low",
       [](const Numbers& n) -> Distribution {
         return LogUniform{n[0], n[1]};
       }},
      {"normal",
       "{mean, sd}",
       {"mean", "sd"},
       true,
       false,
       "Gaussian",
       [](const Numbers& n) -> Distribution {
         return Normal{n[0], n[1]};
       }},
      {"truncated_normal",
       "{mean, sd, low, high}",
       {"mean", "sd", "low", "high"},
       true,
       false,
       "Gaussian of the given mean and sd, conditioned on low to below high",
       [](const Numbers& n) -> Distribution {
         return TruncatedNormal{n[0], n[1], n[2], n[3]};
       }},
      {"lognormal",
       "{median, cv}",
       {"median", "cv"},
       true,
       false,
       "the logarithm is Gaussian; cv is the standard deviation over the mean of the variable itself",
       [](const Numbers& n) -> Distribution {
         return Lognormal{n[0], n[1]};
       }},
      {"triangular",
       "[low, mode, high]",
       {"low", "mode", "high"},
       false,
       false,
       "density rising straight from low to mode and falling straight to high",
       [](const Numbers& n) -> Distribution {
         return Triangular{n[0], n[1], n[2]};
       }},
      {"integers",
       "[low, high]",
       {"low", "high"},
       false,
       true,
       "each whole number from low to high, both included, equally likely",
       [](const Numbers& n) -> Distribution {
         return Integers{static_cast<std::int64_t>(n[0]), static_cast<std::int64_t>(n[1])};
       }},
      {"choice",
       "[value, ...]",
       {},
       false,
       false,
       "each value of the list equally likely",
       [](const Numbers& n) -> Distribution { return Choice{n}; }},
  };
}

}  // namespace

std::span<const DistributionForm> distribution_forms() {
  static const std::vector<DistributionForm> forms = make_forms();
  return forms;
}

std::string distribution_names() {
  std::vector<std::string_view> names;
  for (const DistributionForm& form : distribution_forms()) names.push_back(form.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::optional<Distribution> read_distribution(const DistributionForm& form, const yaml::Field& field,
                                              yaml::Problems& problems) {
  const auto numbers = form.by_key ? read_keys(form, field, problems) : read_list(form, field, problems);
  if (!numbers) return std::nullopt;
  Distribution distribution = form.make(*numbers);
  const auto fault = find_fault(distribution);
  if (fault) {
    problems.add(field.node->place, field.path, fault->what, fault->expected);
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

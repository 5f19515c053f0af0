#include "runners/trials/variant.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_edit.hpp"

namespace zerocount::trials {
namespace {

/// Checks the value of a command-line option against what the study has.
/// @param all the study's conditions or ages
/// @param noun what `all` is, for the message
/// @throws Failure (bad_input) unless `wanted` is one of `all`
void require_one_of(const study::Study& study, const auto& all, const auto& wanted, std::string_view noun,
                    std::string_view option) {
  if (std::ranges::find(all, wanted) != all.end()) return;
  throw Failure(ExitCode::bad_input,
                all.empty() ? fmt::format("{}: it has no {}s; expected no {}", study.name, noun, option)
                            : fmt::format("option '{}': {} is not one of the {}s of {}; expected one of {}",
                                          option, wanted, noun, study.name, fmt::join(all, ", ")));
}

}  // namespace

std::uint64_t fresh_seed(std::uint64_t seed, std::string_view purpose) {
  constexpr unsigned seed_bits = 52;
  return random::random_bits({designs::random_key(seed, purpose), 0}, 0, random::Draw::trial) >>
         (64U - seed_bits);
}

study::Study variant_of(const study::Study& study, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = study.manifest.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return manifest::parse_study(study.manifest.text, study.name, all, sections::external_inputs_of(study));
}

study::Study restricted_to(const study::Study& study, const std::optional<std::string>& condition,
                           const std::optional<double>& age) {
  std::vector<std::string> overrides;
  study::SettingCounts kept = study.settings.counts();
  if (condition) {
    require_one_of(study, study.settings.conditions, *condition, "condition", "--condition");
    overrides.push_back(manifest_text::only_condition(study, *condition));
    kept.conditions = 1;
  }
  if (age) {
    require_one_of(study, study.settings.ages.at, *age, "age", "--age");
    overrides.push_back(fmt::format("ages.at=[{}]", *age));
    kept.ages = 1;
  }
  if (overrides.empty()) return study;
  overrides.push_back(fmt::format("trials={}", study::draw_count(study) * kept.total()));
  if (!study.retained_trials.empty()) overrides.emplace_back("retain={trials: []}");
  study::Study restricted = variant_of(study, overrides);
  restricted.engine = study.engine;
  return restricted;
}

}  // namespace zerocount::trials

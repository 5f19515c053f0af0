// A rule may read the ranges of the parameters that it lists, and no others.
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/rules/value_rules.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/draws.hpp"

namespace zerocount::rules {
namespace {

constexpr int draws_of_ranges = 400;

/// Studies with different rules: in closed and open loop, with profiles, lists, two masses and other laws.
std::vector<study::Study> studies_with_rules() {
  return {study_of(full_manifest()), study_of(extended_manifest()),
          study_of(manifest_commanding("{torque: {levels: [0.1, 0.2]}, hold: 0.1}")),
          study_of(manifest_commanding(
              "{targets: [100], hold: 0.1, profile: {shape: s_curve, velocity_limit: 1000, "
              "acceleration_limit: 1.0e+5, jerk_limit: 1.0e+7}}")),
          study_of(manifest_commanding("{targets: [10], hold: 0.1}",
                                       "plant: {load: {inertia: 1.0e-4, stiffness: 100, damping: 0.01}}\n"
                                       "friction: {model: lugre}\n"))};
}

/// Ranges that lead a rule into each of its branches: numbers of all sizes, 0, and the values of words.
std::vector<study::ParameterRange> random_ranges(std::size_t count, testing::Draws& draws) {
  std::vector<study::ParameterRange> ranges(count);
  for (study::ParameterRange& range : ranges) {
    const auto value = [&] {
      if (draws.chance(0.4)) return static_cast<double>(draws.integer(0, 6));
      return draws.sign() * draws.log_uniform(1e-6, 1e6);
    };
    const double one = value();
    const double other = draws.chance(0.5) ? one : value();
    range = {std::min(one, other), std::max(one, other), std::min(one, other) <= 0.0, one};
  }
  return ranges;
}

/// The message about a parameter that the rule reads and does not list; empty if there is none.
template <class Rule>
std::string unlisted_parameter(const Rule& evaluate) {
  try {
    evaluate();
  } catch (const std::out_of_range&) {  // a random number stands for no word of a key
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(RuleParameters, ValueRulesReadOnlyWhatTheyList) {
  testing::Draws draws(7);
  for (const study::Study& study : studies_with_rules()) {
    std::vector<ValueRule> rules = value_rules(*study.plan);
    for (ValueRule& rule : plausibility_rules(*study.plan)) rules.push_back(std::move(rule));
    for (const ValueRule& rule : rules) {
      for (int i = 0; i < draws_of_ranges; ++i) {
        const std::vector<study::ParameterRange> ranges = random_ranges(rule.between.size(), draws);
        const std::vector<study::ParameterRange> list = random_ranges(3, draws);
        ASSERT_EQ(unlisted_parameter([&] { rule.find_faults(Ranges(rule.between, ranges), list); }), "")
            << "the rule of " << rule.between.front().path;
      }
    }
  }
}

TEST(RuleParameters, EffectRulesReadOnlyWhatTheyDependOn) {
  testing::Draws draws(8);
  for (const study::Study& study : studies_with_rules()) {
    for (const EffectRule& rule : effect_rules(*study.plan)) {
      if (!rule.has_effect) continue;
      for (int i = 0; i < draws_of_ranges; ++i) {
        const std::vector<study::ParameterRange> ranges = random_ranges(rule.depends_on.size(), draws);
        ASSERT_EQ(unlisted_parameter([&] { rule.has_effect(Ranges(rule.depends_on, ranges)); }), "")
            << "the rule: " << rule.what;
      }
    }
  }
}

}  // namespace
}  // namespace zerocount::rules

// Messages about a value say what to write in its place, and that is understood.
#include <regex>

#include "experiments/parameters/parameter_table.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::keys {
namespace {

/// A manifest in which a parameter of one section has this value.
std::string with_value(const parameters::Parameter& parameter, const std::string& value) {
  std::string text = value;
  std::string_view path = parameter.name;
  while (!path.empty()) {
    const std::size_t dot = path.rfind('.');
    text = fmt::format("{}: {}", path.substr(dot == std::string_view::npos ? 0 : dot + 1), text);
    path = dot == std::string_view::npos ? "" : path.substr(0, dot);
    if (!path.empty()) text = "{" + text + "}";
  }
  return text;
}

/// The distribution that the message about the parameter suggests.
std::string suggestion(const std::string& message) {
  const std::size_t start = message.find("such as ");
  return start == std::string::npos ? "" : message.substr(start + 8, message.find("]}", start) - start - 6);
}

TEST(ExpectedValue, MessageNamesTheUnitAndASuitableDistribution) {
  int understood = 0;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (!parameters::has_value(parameter) || parameters::has_labels(parameter) || parameter.only_on ||
        parameter.name.starts_with("command."))
      continue;
    const std::string message = refusal_of(minimal_manifest(with_value(parameter, "'1'") + "\n"));
    ASSERT_TRUE(says(message, "a distribution, such as {"));
    if (parameter.unit != "1") {
      EXPECT_TRUE(says(message, fmt::format(", in {}", parameter.unit)));
    }
    const std::string example = suggestion(message);
    if (example.find("low") != std::string::npos) continue;  // no default other than 0
    const std::string refusal = refusal_of(minimal_manifest(with_value(parameter, example) + "\n"));
    // It may have no effect without other keys; as a value it is right.
    EXPECT_TRUE(refusal.empty() || refusal.find("no effect") != std::string::npos) << example << refusal;
    ++understood;
  }
  EXPECT_GT(understood, 20);
}

TEST(ExpectedValue, AnOutOfRangeMessageNamesUnitAndDistributionToo) {
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("plant: {inertia: «0»}\n")),
                 "«»: plant.inertia | greater than 0, in kg m^2, or a distribution, such as {uniform: "
                 "[0.00044, 0.00066]}"));
  EXPECT_TRUE(
      has_faults(refusal_of(minimal_manifest("dac: {bits: «0»}\n")),
                 "«»: dac.bits | from 1 to 32, in bit, or a distribution, such as {integers: [10, 14]}"));
  EXPECT_TRUE(says(refusal_of(minimal_manifest("axis: linear\nplant: {inertia: «0»}\n")),
                   "«»: plant.inertia: '0' is out of range; expected a number greater than 0, in kg, or a "
                   "distribution, such as {uniform: [low, high]}"));
}

// Random normal distributions: what is suggested in place of each is understood.
TEST(ExpectedValue, AnUnboundedNormalIsAnsweredWithABoundedDistribution) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const double mean = std::exp(std::uniform_real_distribution(-5.0, 8.0)(random));
    const double sd = mean * std::exp(std::uniform_real_distribution(-4.0, 0.5)(random));
    const std::string message = refusal_of(
        minimal_manifest(fmt::format("friction: {{k1: {{normal: {{mean: {}, sd: {}}}}}}}\n", mean, sd)));
    ASSERT_TRUE(says(message, "only, in N m/rad: "));
    for (const char* const form : {R"(\{truncated_normal: \{[^}]*\}\})", R"(\{lognormal: \{[^}]*\}\})"}) {
      std::smatch found;
      ASSERT_TRUE(std::regex_search(message, found, std::regex(form))) << message;
      EXPECT_EQ(refusal_of(minimal_manifest("friction: {k1: " + found.str() + "}\n")), "");
    }
  }
  EXPECT_TRUE(has_faults(
      refusal_of(minimal_manifest("friction: {coulomb_ratio: {normal: «{mean: 0.8, sd: 0.1}»}}\n")),
      "«»: friction.coulomb_ratio.normal | {truncated_normal: {mean: 0.8, sd: 0.1, low: 0.5, high: 1}}"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {k1: {normal: «{mean: -1, sd: 0.1}»}}\n")),
                         "«»: friction.k1.normal | truncated_normal or lognormal"));
  EXPECT_TRUE(has_faults(refusal_of(minimal_manifest("friction: {k1: {uniform: «[-1, 1]»}}\n")),
                         "«»: friction.k1.uniform | only, in N m/rad"));
}

TEST(ExpectedValue, AnotherCommonNameIsAnsweredWithTheParameter) {
  for (const char* const axis : {"rotary", "linear"}) {
    const std::string head = fmt::format("axis: {}\n", axis);
    EXPECT_TRUE(
        says(refusal_of(minimal_manifest(head + "plant: {mass: 5}\n")), "nearest known: plant.inertia"));
    EXPECT_TRUE(says(refusal_of(minimal_manifest(head + "mass: 5\n")), "nearest known: plant.inertia"));
    EXPECT_TRUE(
        says(refusal_of(minimal_manifest(head + "dac: {full_scale: 5}\n")), "nearest known: dac.range"));
  }
}

}  // namespace
}  // namespace zerocount::keys

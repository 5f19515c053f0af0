// Every parameter of the table refuses a text and the numbers beyond its range, with one message: at the
// place of the value, with the dotted name and what is expected.
#include "experiments/parameters/parameter_table.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::parameters {
namespace {

/// A parameter that a manifest states, with nothing beside it in its section.
struct StatedParameter {
  const Parameter& row;
  AxisKind axis{AxisKind::rotary};

  /// Dotted name of the value, in which # is the first element of a list. The keys of a filter stand in a
  /// map that names its kind.
  std::string path() const {
    std::string text(row.name);
    const std::size_t of_filter = text.find(".filters.#.");
    if (of_filter == std::string::npos) return text;
    const std::size_t key = of_filter + std::string_view(".filters.#.").size();
    static const std::map<std::string_view, std::string> kinds{
        {"frequency", "lowpass"}, {"damping", "lowpass"}, {"depth", "notch"},
        {"ratio", "lead"},        {"b", "biquad"},        {"a", "biquad"}};
    return text.insert(key, kinds.at(row.name.substr(key)) + ".");
  }

  /// Dotted name of the value in messages; of a list the name of its first value.
  std::string name() const {
    std::string text = path();
    if (const std::size_t element = text.find('#'); element != std::string::npos) text[element] = '0';
    return is_list(row) ? text + ".0" : text;
  }
};

/// The line of a manifest that states this value of the parameter. Further values of a list are 1.
std::string line_with(const StatedParameter& stated, const std::string& value) {
  std::string text = value;
  if (is_list(stated.row)) {
    for (std::size_t i = 1; i < stated.row.list->min_values; ++i) text += ", 1";
    text = "[" + text + "]";
  }
  const std::string whole = stated.path();
  std::string_view path = whole;
  while (true) {
    const std::size_t dot = path.rfind('.');
    const std::string_view key = path.substr(dot == std::string_view::npos ? 0 : dot + 1);
    text = key == "#" ? "[" + text + "]" : fmt::format("{}: {}", key, text);
    if (dot == std::string_view::npos) return text;
    path = path.substr(0, dot);
    if (key != "#") text = "{" + text + "}";
  }
}

/// Overrides for the other keys that a study with this parameter must have.
std::vector<std::string> required_keys(const StatedParameter& stated) {
  std::vector<std::string> keys;
  if (stated.axis == AxisKind::linear) {
    keys = {"axis=linear",
            "plant.inertia=5",
            "plant.presliding_damping=1500",
            "plant.sliding_damping=50",
            "friction.k1=1.0e+5",
            "friction.k2=2.0e+7",
            "friction.beta=2.0e+6",
            "friction.lambda=1.0e+8",
            "friction.breakaway=12",
            "friction.stribeck_velocity=1.0e-3",
            "encoder.resolution=1.0e-9",
            "dac.bits=20",
            "dac.resolution=5.0e-5",
            "controller.ki=5.0e-6"};
  }
  const std::string_view name = stated.row.name;
  if (name.starts_with("command.torque.")) {
    keys.push_back("command.torque.levels=[0.1]");
  } else if (name.starts_with("command.sequence.")) {
    keys.push_back("command.sequence.targets=[1, 2]");
    keys.push_back("command.sequence.overrun=1");
  } else {
    keys.push_back("command.targets=[5]");
  }
  const std::string own = std::string(name) + "=";
  std::erase_if(keys, [&](const std::string& key) { return key.starts_with(own); });
  return keys;
}

/// The message without lines about missing keys and about values without effect: the value stands alone in
/// its section.
std::string about_values(const std::string& message) {
  std::istringstream lines(message);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(": it has no effect: ") != std::string::npos) continue;
    if (line.find(": the key is missing; ") != std::string::npos) continue;
    kept += (kept.empty() ? "" : "\n") + line;
  }
  return kept;
}

/// Expects that this value is refused with one message that has these words.
void expect_refusal(const StatedParameter& stated, const std::string& value,
                    const std::vector<std::string>& words) {
  const std::string text =
      "zerocount: 1\nname: test\nseed: 1\ntrials: 10\n" + line_with(stated, "«" + value + "»") + "\n";
  EXPECT_TRUE(has_faults(about_values(refusal_of(text, required_keys(stated))),
                         fmt::format("«»: {} | {}", stated.name(), fmt::join(words, " | "))))
      << text;
}

/// Text of the range in messages about a value.
std::string expected_of(const Parameter& row) {
  if (row.kind == ParameterKind::boolean) return "true or false";
  if (has_labels(row)) return fmt::format("one of {}", fmt::join(row.labels, ", "));
  if (row.kind == ParameterKind::whole_number)
    return fmt::format("a whole number from {} to {}", static_cast<std::int64_t>(row.range.low),
                       static_cast<std::int64_t>(row.range.high));
  const std::string range = numerics::range_text(row.range);
  return range.starts_with("any") ? range : "a number " + range;
}

std::vector<StatedParameter> stated_parameters() {
  std::vector<StatedParameter> all;
  for (const Parameter& row : parameter_table()) all.push_back({row, row.only_on.value_or(AxisKind::rotary)});
  return all;
}

TEST(ParameterRefusals, ATextIsNotAValue) {
  for (const StatedParameter& stated : stated_parameters())
    expect_refusal(stated, "heavy", {"heavy", expected_of(stated.row)});
}

/// The nearest values outside a range.
std::vector<std::string> values_beyond(const Parameter& row) {
  std::vector<std::string> values;
  const numerics::Interval& range = row.range;
  if (row.kind == ParameterKind::whole_number) {
    values = {fmt::format("{}", static_cast<std::int64_t>(range.low) - 1),
              fmt::format("{}", static_cast<std::int64_t>(range.high) + 1)};
  } else {
    const auto add = [&](double end, bool included, double beyond) {
      if (std::isfinite(end))
        values.push_back(fmt::format("{}", included ? std::nextafter(end, beyond) : end));
    };
    add(range.low, range.low_included, -std::numeric_limits<double>::infinity());
    add(range.high, range.high_included, std::numeric_limits<double>::infinity());
  }
  return values;
}

TEST(ParameterRefusals, NumbersBeyondTheRangeAreRefused) {
  int refused = 0;
  for (const StatedParameter& stated : stated_parameters()) {
    if (has_labels(stated.row)) continue;
    for (const std::string& value : values_beyond(stated.row)) {
      expect_refusal(stated, value, {fmt::format("'{}' is out of range", value), expected_of(stated.row)});
      ++refused;
    }
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace zerocount::parameters

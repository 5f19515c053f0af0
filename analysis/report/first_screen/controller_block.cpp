#include "analysis/report/first_screen/controller_block.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/report/first_screen/quantity.hpp"

namespace zerocount::report {
namespace {

/// Lines of one phase of the control. @param path "controller." or "controller.coarse."
class PhaseLines {
 public:
  PhaseLines(const PointValues& values, std::string path) : values_(values), path_(std::move(path)) {}

  void add(const loop::ControlBlocks& blocks) {
    if (blocks.structure == loop::ControlStructure::cascade) {
      add_group("cascade: ", {{"kv", "cascade.kv"}, {"kp", "cascade.kp"}, {"ki", "cascade.ki"}}, ", ");
    } else {
      for (const char* const gain : {"kp", "ki", "kd"}) add_positive(gain, gain);
    }
    add_unless_none("derivative low-pass", "derivative_cutoff");
    add_unless_none("integrates within", "integrator_zone");
    add_unless_none("integral decays in", "integrator_leak");
    add_unless_none("integral frozen within", "deadband.enter");
    add_unless_none("dead zone", "error_deadband.band");
    add_unless_none("torque held within", "hold.enter");
    if (add_unless_none("standstill gains within", "standstill.band"))
      add_group("  ", {{"kp", "standstill.kp"}, {"ki", "standstill.ki"}, {"kd", "standstill.kd"}}, ", ");
    for (std::size_t i = 0; i < blocks.filters.size(); ++i)
      lines.push_back(filter_text(i, blocks.filters[i]));
    add_group("feed-forward ",
              {{"velocity", "feedforward.velocity"},
               {"acceleration", "feedforward.acceleration"},
               {"friction", "feedforward.friction"}},
              ", ");
    if (values_.can_be_positive(path_ + "observer.bandwidth"))
      add_group("observer ", {{"", "observer.bandwidth"}, {"of", "observer.inertia"}}, " ");
  }

  std::vector<std::string> lines{};

 private:
  struct Named {
    std::string_view name;
    std::string_view key;
  };

  std::string text(std::string_view key) const { return values_.text(path_ + std::string(key)); }

  void add_positive(std::string_view name, std::string_view key) {
    if (values_.can_be_positive(path_ + std::string(key)))
      lines.push_back(fmt::format("{} {}", name, text(key)));
  }
  /// Adds a parameter that can be "none".
  bool add_unless_none(std::string_view name, std::string_view key) {
    if (values_.is_none(path_ + std::string(key))) return false;
    lines.push_back(fmt::format("{} {}", name, text(key)));
    return true;
  }
  /// Those of the parameters that can be positive, in one line.
  void add_group(std::string_view head, const std::vector<Named>& rows, std::string_view separator) {
    std::vector<std::string> texts;
    for (const Named& row : rows) {
      if (values_.can_be_positive(path_ + std::string(row.key)))
        texts.push_back(fmt::format("{}{}{}", row.name, row.name.empty() ? "" : "\u00a0", text(row.key)));
    }
    if (!texts.empty()) lines.push_back(fmt::format("{}{}", head, fmt::join(texts, separator)));
  }

  std::string filter_text(std::size_t index, const loop::Filter& filter) const {
    const auto frequency = [&] { return text(fmt::format("filters.{}.frequency", index)); };
    switch (filter.kind) {
      case loop::FilterKind::lowpass:
        return "low-pass " + frequency();
      case loop::FilterKind::notch:
        return "notch " + frequency();
      case loop::FilterKind::lead:
        return "lead " + frequency();
      case loop::FilterKind::biquad:
        break;
    }
    return fmt::format("biquad b {}; a {}", fmt::join(filter.b, ", "), fmt::join(filter.a, ", "));
  }

  const PointValues& values_;
  std::string path_;
};

std::vector<std::string> plugin_lines(const PointValues& values, const trial::TrialParameters& p) {
  std::vector<std::string> lines{"plugin " + p.controller.user.plugin->description.name};
  for (const plugin::PluginParameter& one : p.controller.user.plugin->description.parameters)
    lines.push_back(fmt::format("{} {}", one.name, values.text("controller.parameters." + one.name)));
  return lines;
}

}  // namespace

DiagramBlock controller_block(const PointValues& values, const trial::TrialParameters& p) {
  const bool is_plugin = p.controller.user.plugin != nullptr;
  const bool is_cascade = p.controller.blocks.structure == loop::ControlStructure::cascade;
  DiagramBlock block{
      is_plugin    ? "Controller"
      : is_cascade ? "Cascade control"
                   : "PID control",
      {fmt::format("{}, delay {}", values.text("controller.sample_rate"), values.text("controller.delay"))}};
  const auto append = [&](const std::vector<std::string>& lines) {
    block.lines.insert(block.lines.end(), lines.begin(), lines.end());
  };
  if (is_plugin) {
    append(plugin_lines(values, p));
    return block;
  }
  PhaseLines fine(values, "controller.");
  fine.add(p.controller.blocks);
  append(fine.lines);
  if (values.can_be_positive("controller.dither.amplitude"))
    block.lines.push_back("dither " + values.text("controller.dither.amplitude"));
  if (!study::can_have_coarse_phase(values.limits("controller.coarse.coarse_beyond"))) return block;
  block.lines.push_back("coarse phase beyond " + values.text("controller.coarse.coarse_beyond"));
  PhaseLines coarse(values, "controller.coarse.");
  coarse.add(p.controller.coarse.blocks);
  append(coarse.lines);
  return block;
}

}  // namespace zerocount::report

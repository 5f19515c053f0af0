#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "core/friction/law.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/text/counted.hpp"
#include "experiments/study/plan.hpp"

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

/// The blocks of the controller that are on, with their gains.
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

std::string on_axis(const PointValues& values, std::string_view text) {
  return parameters::text_on(values.study().units.axis, text);
}
std::string unit_on_axis(const PointValues& values, std::string_view rotary) {
  return parameters::unit_on(values.study().units.axis, rotary);
}

/// "20, 21, 20, 0 µm", or of many or drawn values their range.
std::string moves_text(const PointValues& values) {
  constexpr std::size_t max_listed = 4;
  const study::StudyPlan& plan = *values.study().plan;
  const std::string unit = parameters::unit_of(plan.table.rows[plan.list.first], plan.units);
  std::vector<double> each;
  study::ValueLimits all{INFINITY, -INFINITY};
  for (const std::size_t slot : study::slots_of(plan.list)) {
    const study::ValueLimits one = values.limits(slot);
    all.low = std::min(all.low, one.low);
    all.high = std::max(all.high, one.high);
    if (one.low == one.high) each.push_back(one.low);
  }
  if (each.size() == plan.list.count && each.size() <= max_listed) return list_text(each, unit);
  return fmt::format("{}, {}", text::counted(plan.list.count, "move"), range_text(all.low, all.high, unit));
}

DiagramBlock levels_block(const PointValues& values) {
  return {on_axis(values, "$Torque levels"),
          {moves_text(values), "at " + values.text("command.torque.rate")}};
}

void add_profile(std::vector<std::string>& lines, const PointValues& values, loop::ReferenceShape shape) {
  const auto text = [&](const char* key) { return values.text(std::string("command.profile.") + key); };
  switch (shape) {
    case loop::ReferenceShape::step:
      lines.emplace_back("in steps");
      return;
    case loop::ReferenceShape::sine:
      lines.push_back(fmt::format("sine of {}, {}", text("amplitude"), text("frequency")));
      return;
    case loop::ReferenceShape::trapezoidal:
      lines.emplace_back("trapezoidal velocity");
      break;
    case loop::ReferenceShape::s_curve:
      lines.push_back("s-curve, jerk\u00a0≤\u00a0" + text("jerk_limit"));
      break;
  }
  lines.push_back("velocity ≤\u00a0" + text("velocity_limit"));
  lines.push_back("acceleration ≤\u00a0" + text("acceleration_limit"));
}

DiagramBlock reference_block(const PointValues& values, const trial::TrialParameters& p) {
  DiagramBlock block{"Reference", {"to " + moves_text(values)}};
  add_profile(block.lines, values, p.command.profile.shape);
  block.lines.push_back("hold " + values.text("command.hold"));
  return block;
}

DiagramBlock drive_block(const PointValues& values, const trial::TrialParameters& p) {
  const std::string unit = unit_on_axis(values, "N m");
  DiagramBlock block{
      "DAC and amplifier",
      {fmt::format("{}, ±{}", values.text("dac.bits"), quantity_text(-loop::lowest_torque(p.dac), unit)),
       fmt::format("1 code = {}", quantity_text(p.dac.resolution, unit))}};
  block.lines.push_back(values.can_be_positive("amplifier.bandwidth")
                            ? "bandwidth " + values.text("amplifier.bandwidth")
                            : "ideal amplifier");
  if (values.can_be_positive("dac.noise")) block.lines.push_back("noise " + values.text("dac.noise"));
  return block;
}

void add_damping(DiagramBlock& block, const PointValues& values, const friction::LawTraits& law) {
  if (law.has_presliding_damping) block.lines.push_back("damping " + values.text("plant.presliding_damping"));
  if (law.has_sliding_damping)
    block.lines.push_back("sliding damping " + values.text("plant.sliding_damping"));
}

DiagramBlock plant_block(const PointValues& values, const trial::TrialParameters& p) {
  DiagramBlock block{on_axis(values, "Motor and $rotor"),
                     {on_axis(values, "$inertia ") + values.text("plant.inertia")}};
  add_damping(block, values, friction::traits_of(p.friction.model));
  if (!values.can_be_positive("plant.load.inertia")) return block;
  block.lines.push_back("load " + values.text("plant.load.inertia"));
  block.lines.push_back("coupling " + values.text("plant.load.stiffness"));
  return block;
}

/// The virgin curve as it was measured; empty where the manifest gives the parameters of the law.
std::vector<std::string> measured_lines(const PointValues& values) {
  const auto text = [&](const char* key) { return values.text(std::string("friction.measured.") + key); };
  for (const study::MeasuredSlots& group : values.study().plan->measured) {
    const std::string_view first = group.group->names.front();
    if (first == "friction.measured.secant_stiffness")
      return {fmt::format("{} over {}", text("secant_stiffness"), text("secant_travel")),
              fmt::format("slides at {} after {}", text("breakaway"), text("breakaway_travel"))};
    if (first == "friction.measured.initial_stiffness")
      return {"stiffness " + text("initial_stiffness"), "softens to " + text("final_stiffness"),
              fmt::format("slides at {} after {}", text("breakaway"), text("breakaway_travel"))};
  }
  return {};
}

/// The main parameters that the law uses.
std::vector<std::string> law_lines(const PointValues& values, const trial::TrialParameters& p) {
  struct Row {
    friction::ContactField field;
    const char* word;
    const char* key;
  };
  using F = friction::FrictionParameters;
  static const std::vector<Row> rows{{&F::k1, "k1", "friction.k1"},
                                     {&F::k2, "k2", "friction.k2"},
                                     {&F::sigma0, "σ0", "friction.sigma0"},
                                     {&F::breakaway, "breakaway", "friction.breakaway"}};
  const friction::LawTraits& law = friction::traits_of(p.friction.model);
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    if (friction::uses(law, row.field)) lines.push_back(fmt::format("{} {}", row.word, values.text(row.key)));
  }
  return lines;
}

std::optional<DiagramBlock> friction_block(const PointValues& values, const trial::TrialParameters& p) {
  const friction::FrictionModel model = p.friction.model;
  if (!friction::has_friction(model)) return std::nullopt;
  DiagramBlock block{
      fmt::format("Friction: {}", friction::friction_model_labels()[static_cast<std::size_t>(model)]),
      measured_lines(values)};
  if (block.lines.empty()) block.lines = law_lines(values, p);
  if (friction::has_creep(model) && values.can_be_positive("friction.alpha"))
    block.lines.push_back("creep rate " + values.text("friction.alpha"));
  return block;
}

std::optional<DiagramBlock> disturbance_block(const PointValues& values, const trial::TrialParameters& p) {
  DiagramBlock block{"Disturbance", {}};
  const study::ValueLimits torque = values.limits("disturbance.torque");
  if (torque.low != 0.0 || torque.high != 0.0)
    block.lines.push_back("constant " + values.text("disturbance.torque"));
  for (std::size_t i = 0; i < p.disturbance.ripple.size(); ++i)
    block.lines.push_back("ripple " + values.text(fmt::format("disturbance.ripple.{}.amplitude", i)));
  for (std::size_t i = 0; i < p.disturbance.vibration.size(); ++i)
    block.lines.push_back(fmt::format("{} at {}",
                                      values.text(fmt::format("disturbance.vibration.{}.amplitude", i)),
                                      values.text(fmt::format("disturbance.vibration.{}.frequency", i))));
  if (!p.disturbance.spectra.empty()) block.lines.emplace_back("random vibration");
  if (block.lines.empty()) return std::nullopt;
  return block;
}

DiagramBlock encoder_block(const PointValues& values, const trial::TrialParameters& p) {
  const std::string length = unit_on_axis(values, "rad");
  DiagramBlock block{"Encoder", {}};
  block.lines.push_back("1 count = " + quantity_text(loop::fine_resolution(p.encoder), length));
  if (values.can_be_positive("encoder.fine_errors.noise"))
    block.lines.push_back("noise " + values.text("encoder.fine_errors.noise") + " rms");
  if (values.can_be_positive("encoder.fine_errors.interpolation"))
    block.lines.push_back("interpolation error " + values.text("encoder.fine_errors.interpolation"));
  if (values.can_be_positive("plant.load.inertia"))
    block.lines.push_back(p.plant.load.encoder == motion::EncoderPlace::load ? "at the load"
                                                                             : "at the motor");
  if (p.controller.encoder == loop::EncoderChoice::coarse)
    block.lines.push_back("the coarse one closes the loop: 1 count = " +
                          quantity_text(loop::coarse_resolution(p.encoder), length));
  return block;
}

}  // namespace

AxisDiagram axis_diagram(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  const trial::TrialParameters p = study::commanded_trial(study, point, 0).parameters;
  AxisDiagram diagram{.reference = study.open_loop ? levels_block(values) : reference_block(values, p),
                      .drive = drive_block(values, p),
                      .plant = plant_block(values, p),
                      .friction = friction_block(values, p),
                      .disturbance = disturbance_block(values, p),
                      .encoder = encoder_block(values, p)};
  if (!study.open_loop) diagram.controller = controller_block(values, p);
  return diagram;
}

std::string diagram_html(const AxisDiagram& diagram) {
  const auto block = [](const char* place, const DiagramBlock& one, const std::string& inner = "") {
    std::string html = fmt::format("<div class=\"block {}\"><b>{}</b>", place, document::markup(one.title));
    for (const std::string& line : one.lines) html += fmt::format("<span>{}</span>", document::markup(line));
    return html + inner + "</div>\n";
  };
  std::string acts_on_plant;
  if (diagram.disturbance) acts_on_plant = block("disturbance", *diagram.disturbance);
  if (diagram.friction) acts_on_plant += block("friction", *diagram.friction);
  return "<div class=\"axis\">\n" + block("reference", diagram.reference) +
         (diagram.controller ? "<i class=\"sum\">−</i>\n" + block("controller", *diagram.controller) : "") +
         block("drive", diagram.drive) + block("plant", diagram.plant, acts_on_plant) +
         block("encoder", diagram.encoder) +
         (diagram.controller ? "<i class=\"back\"></i><i class=\"rise\"></i>" : "") +
         "<i class=\"out\"></i><i class=\"home\"></i></div>\n";
}

}  // namespace zerocount::report

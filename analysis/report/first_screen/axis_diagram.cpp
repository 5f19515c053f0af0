#include <algorithm>
#include <cmath>
#include <map>

#include <boost/algorithm/string/finder.hpp>
#include <boost/algorithm/string/iter_find.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/first_screen/first_screen.hpp"
#include "core/friction/law.hpp"
#include "core/loop/dac.hpp"
#include "core/loop/encoder.hpp"
#include "core/text/text.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::report {
namespace {

using boost::algorithm::replace_all_copy;

/// The targets of the moves as text: "20, 21, 20, 0 µm"; if they are many or random, their range.
std::string moves_text(const PointValues& values) {
  constexpr std::size_t max_listed = 4;
  const study::StudyPlan& plan = *values.study().plan;
  const std::string unit = parameters::unit_of(plan.table.rows[plan.list.first], plan.units);
  std::vector<double> each;
  study::ParameterRange all{INFINITY, -INFINITY};
  for (const std::size_t slot : study::slots_of(plan.list)) {
    const study::ParameterRange one = values.limits(slot);
    all.low = std::min(all.low, one.low);
    all.high = std::max(all.high, one.high);
    if (one.low == one.high) each.push_back(one.low);
  }
  if (each.size() == plan.list.count && each.size() <= max_listed) return list_text(each, unit);
  return fmt::format("{}, {}", text::counted(plan.list.count, "move"), range_text(all.low, all.high, unit));
}

/// Values for names in the template axis.html that are not parameters: computed texts, and an empty text for
/// each component that is switched on.
using Facts = std::map<std::string, std::string, std::less<>>;

void add(Facts& facts, const std::string& name, bool is_on) {
  if (is_on) facts.emplace(name, "");
}

void add_controller(Facts& facts, const PointValues& values, const trial::TrialParameters& p) {
  facts["shape"] = values.text(parameter::command::profile::shape);
  if (const plugin::ControllerPlugin* const plugin = p.controller.user.plugin.get()) {
    facts["plugin"] = plugin->description.name;
    const std::vector<plugin::PluginParameter>& own = plugin->description.parameters;
    for (std::size_t i = 0; i < own.size(); ++i)
      facts[fmt::format("plugin.{}", i)] =
          fmt::format("{} {}", own[i].name, values.text("controller.parameters." + own[i].name));
    return;
  }
  facts["structure"] = values.text(parameter::controller::structure);
  add(facts, "coarse",
      study::can_have_coarse_phase(values.limits(parameter::controller::coarse::coarse_beyond)));
}

void add_friction(Facts& facts, const PointValues& values, friction::FrictionModel model) {
  using F = friction::FrictionParameters;
  const friction::LawTraits& law = friction::traits_of(model);
  add(facts, "presliding damping", law.has_presliding_damping);
  add(facts, "sliding damping", law.has_sliding_damping);
  add(facts, "friction", friction::has_friction(model));
  add(facts, "creep", friction::has_creep(model));
  add(facts, "uses friction.k1", friction::uses(law, &F::k1));
  add(facts, "uses friction.k2", friction::uses(law, &F::k2));
  add(facts, "uses friction.sigma0", friction::uses(law, &F::sigma0));
  add(facts, "uses friction.breakaway", friction::uses(law, &F::breakaway));
  for (const study::MeasuredSlots& group : values.study().plan->measured) {
    const std::vector<std::string_view>& names = group.group->names;
    add(facts, fmt::format("by {}", names.front()), true);
    add(facts, "measured", std::ranges::find(names, parameter::friction::measured::breakaway) != names.end());
  }
}

/// Adds what the diagram says about the masses of the axis and about the encoders that the control loops
/// read.
void add_masses(Facts& facts, const PointValues& values, const trial::TrialParameters& p) {
  if (!motion::has_load(p.plant)) return;
  const auto name = [](motion::EncoderPlace mass) { return std::string(study::mass_text(mass)); };
  const motion::EncoderPlace closing = p.plant.load.encoder;  // once the trial is complete
  const motion::EncoderPlace other =
      closing == motion::EncoderPlace::load ? motion::EncoderPlace::motor : motion::EncoderPlace::load;
  const parameters::AxisKind axis = values.study().units.axis;
  add(facts, "two masses", true);
  add(facts, "friction of the load", p.load_side.friction.model != friction::LoadFrictionModel::none);
  const study::ParameterRange constant = values.limits(parameter::disturbance::load::torque);
  if (constant.low != 0.0 || constant.high != 0.0)
    facts["constant on the load"] = values.text(parameter::disturbance::load::torque);
  facts["closing mass"] = name(closing);
  const bool is_cascade = p.controller.blocks.structure == loop::ControlStructure::cascade;
  if (!values.study().open_loop) facts["loop that it closes"] = is_cascade ? "position loop" : "loop";
  if (!loop::has_other(p.encoder)) return;
  add(facts, "two encoders", true);
  facts["other mass"] = name(other);
  facts["other count"] = quantity_text(loop::other_resolution(p.encoder), parameters::unit_on(axis, "rad"));
  if (is_cascade && !values.study().open_loop)
    facts["velocity loop"] = name(p.controller.velocity_by_other ? other : closing);
}

void add_disturbance(Facts& facts, const PointValues& values,
                     const trial::DisturbanceParameters& disturbance) {
  const study::ParameterRange constant = values.limits(parameter::disturbance::torque);
  add(facts, "constant", constant.low != 0.0 || constant.high != 0.0);
  add(facts, "random", !disturbance.spectra.empty());
  add(facts, "disturbed",
      facts.contains("constant") || facts.contains("random") || !disturbance.ripple.empty() ||
          !disturbance.vibration.empty());
}

Facts facts_of(const PointValues& values, const trial::TrialParameters& p) {
  const parameters::AxisKind axis = values.study().units.axis;
  const std::string torque = parameters::unit_on(axis, "N m"), length = parameters::unit_on(axis, "rad");
  Facts facts{{"moves", moves_text(values)},
              {"range", quantity_text(-loop::lowest_torque(p.dac), torque)},
              {"code", quantity_text(p.dac.resolution, torque)},
              {"count", quantity_text(loop::fine_resolution(p.encoder), length)},
              {"coarse count", quantity_text(loop::coarse_resolution(p.encoder), length)},
              {values.study().open_loop ? "open" : "closed", ""}};
  if (!values.study().open_loop) add_controller(facts, values, p);
  add_friction(facts, values, p.friction.model);
  add_disturbance(facts, values, p.disturbance);
  add_masses(facts, values, p);
  return facts;
}

std::vector<std::string> divided(std::string_view text, const char* separator) {
  std::vector<std::string> parts;
  boost::algorithm::iter_split(parts, text, boost::algorithm::first_finder(separator));
  return parts;
}

/// Fills the template axis.html with the values of a study, line by line:
///
///     {NAME}             the value of the parameter, over all trials and settings, or the fact
///     {NAME>0}, {NAME?}  the same, only if the value can be above 0; only if it is not the word "none"
///     {if NAME}          no text: keeps the part only if NAME has a value; {unless NAME} only if it has none
///     {if NAME=a,b}      no text: keeps the part only if the value is one of these words
///     #                  0, 1, …: lines that follow each other, for each element of a list
///     head | a | b       a part that cannot be filled is left out; a head that ends with a colon needs one
///     ~                  a space without a line break
///
/// A line that cannot be filled is left out: the study has no such value. Lines without markup are lines of a
/// block.
class AxisTemplate {
 public:
  AxisTemplate(const PointValues& values, Facts facts) : values_(values), facts_(std::move(facts)) {}

  std::string filled(const std::string& pattern) const {
    std::string html, of_elements;
    for (const std::string& line : divided(pattern + "\n", "\n")) {
      if (line.find('#') != std::string::npos) {
        of_elements += line + "\n";
        continue;
      }
      std::string element = of_elements;
      for (int i = 0; !element.empty(); ++i) {
        element = filled(replace_all_copy(of_elements, "#", std::to_string(i)));
        html += element;
      }
      of_elements.clear();
      html += line_html(line);
    }
    return html;
  }

 private:
  std::string line_html(const std::string& line) const {
    const std::vector<std::string> parts = divided(line, " | ");
    std::optional<std::string> text = part(parts.front());
    std::vector<std::string> more;
    for (std::size_t i = 1; i < parts.size(); ++i)
      if (std::optional<std::string> one = part(parts[i])) more.push_back(std::move(*one));
    if (!text || text->empty() || (text->ends_with(':') && more.empty())) return "";
    if (!more.empty()) *text += fmt::format("{}{}", text->ends_with(':') ? " " : ", ", fmt::join(more, ", "));
    return (text->starts_with('<') ? *text : fmt::format("<span>{}</span>", *text)) + "\n";
  }

  /// The pattern with its names replaced by their values; nothing if one of the names has no value.
  std::optional<std::string> part(std::string_view pattern) const {
    std::string text;
    for (std::size_t open = pattern.find('{'); open != std::string_view::npos; open = pattern.find('{')) {
      const std::size_t close = pattern.find('}');
      const std::optional<std::string> value = replacement(pattern.substr(open + 1, close - open - 1));
      if (!value) return std::nullopt;
      text += std::string(pattern.substr(0, open)) + document::markup(*value);
      pattern.remove_prefix(close + 1);
    }
    return replace_all_copy(text + std::string(pattern), "~", "\u00a0");
  }

  std::optional<std::string> replacement(std::string_view name) const {
    constexpr std::string_view kept = "if ", left_out = "unless ";
    const auto nothing = [](bool is_kept) { return is_kept ? std::optional<std::string>("") : std::nullopt; };
    if (name.starts_with(left_out)) return nothing(!value(name.substr(left_out.size())));
    if (!name.starts_with(kept)) return value(name);
    name.remove_prefix(kept.size());
    const std::size_t words = std::min(name.find('='), name.size());
    const std::optional<std::string> found = value(name.substr(0, words));
    if (!found || words == name.size()) return nothing(found.has_value());
    const std::vector<std::string> wanted = divided(name.substr(words + 1), ",");
    return nothing(std::ranges::find(wanted, *found) != wanted.end());
  }

  std::optional<std::string> value(std::string_view name) const {
    if (const auto fact = facts_.find(name); fact != facts_.end()) return fact->second;
    const bool positive = name.ends_with(">0"), given = name.ends_with('?');
    name.remove_suffix(positive ? 2 : given ? 1 : 0);
    if (!values_.has(name) || (positive && !values_.can_be_positive(name)) ||
        (given && values_.is_none(name)))
      return std::nullopt;
    return values_.text(name);
  }

  const PointValues& values_;
  Facts facts_;
};

}  // namespace

std::string diagram_html(const study::Study& study, std::int64_t point) {
  const PointValues values(study, point);
  const Facts facts = facts_of(values, study::commanded_trial(study, point, 0).parameters);
  std::string pattern(embedded_file("axis.html"));
  for (const auto& [phase, is_on] : {std::pair("controller.", "structure"), {"controller.coarse.", "coarse"}})
    pattern = replace_all_copy(
        pattern, fmt::format("{{phase {}}}", phase),
        facts.contains(is_on) ? replace_all_copy(std::string(embedded_file("axis_phase.html")), "@", phase)
                              : "");
  return AxisTemplate(values, facts).filled(parameters::text_on(study.units.axis, pattern));
}

}  // namespace zerocount::report

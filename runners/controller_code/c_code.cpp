#include <algorithm>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "core/loop/dac.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {
namespace {

Notation c_notation(Precision precision) {
  const bool single = precision == Precision::single_precision;
  return {.precision = precision,
          .number_suffix = single ? "F" : "",
          .input = "in->",
          .state = "s->",
          .no = "0",
          .yes = "1",
          .forms = {{Operation::both, "{0} && {1}"},
                    {Operation::either, "{0} || {1}"},
                    {Operation::negation, "!{0}"},
                    {Operation::count_difference, "(float)({0} - {1})"},
                    {Operation::magnitude, "magnitude({0})"},
                    {Operation::limited, "limited({0}, {1}, {2})"},
                    {Operation::nearest, "whole({0})"},
                    {Operation::is_even, "((int64_t)({0}) % 2 == 0)"},
                    {Operation::choice, "({0} ? {1} : {2})"}},
          .lines = {.assignment = "{} = {};",
                    .if_begins = "if ({}) {{",
                    .otherwise = "}} else {{",
                    .if_ends = "}}",
                    .remark = "/* {} */"}};
}

/// The text, changed so that it does not end the C comment into which it is put.
std::string in_comment(const std::string& text) {
  return boost::algorithm::replace_all_copy(text, "*/", "* /");
}

std::string_view number_type(Precision precision) {
  return precision == Precision::single_precision ? "float" : "double";
}

std::string_view type_text(Type type, Precision precision) {
  if (type == Type::flag) return "int";
  if (type == Type::count && precision == Precision::single_precision) return "int64_t";
  return number_type(precision);
}

/// C declarations of all variables that have this role, as members of a struct.
std::string members(const Program& program, Role role) {
  std::string text;
  for (const Variable& variable : program.variables) {
    if (variable.role == role)
      text += fmt::format("  {} {}; /* {} */\n", type_text(variable.type, program.precision), variable.name,
                          variable.meaning);
  }
  return text;
}

/// C definitions of the helper functions that the statements call, and no others.
/// @param statements C text of the statements
/// @param type C type of a number
/// @param zero text of the number 0 in this type
std::string functions(std::string_view statements, std::string_view type, std::string_view zero) {
  std::string text;
  if (statements.find("magnitude(") != std::string_view::npos)
    text += fmt::format("static inline {0} magnitude({0} x) {{ return x < {1} ? -x : x; }}\n", type, zero);
  if (statements.find("limited(") != std::string_view::npos) {
    text += fmt::format(
        "static inline {0} limited({0} x, {0} lowest, {0} highest) {{\n"
        "  const {0} above = x < lowest ? lowest : x;\n"
        "  return highest < above ? highest : above;\n"
        "}}\n",
        type);
  }
  if (statements.find("whole(") != std::string_view::npos) {
    // At this size a number has no digit behind the point.
    text += fmt::format("static inline {0} whole({0} x) {{ return (x + {1}) - {1}; }}\n", type,
                        type == "float" ? "12582912.0F" : "6755399441055744.0");
  }
  return text.empty() ? text : "\n" + text;
}

std::string locals(const Program& program) {
  std::string text;
  for (const Variable& variable : program.variables) {
    if (variable.role == Role::local)
      text += fmt::format("  {} {};\n", type_text(variable.type, program.precision), variable.name);
  }
  return text;
}

std::string chain_code(const ControllerToWrite& chain, const Program& program) {
  const Notation notation = c_notation(program.precision);
  const std::string_view type = number_type(program.precision);
  const std::string statements = statements_text(program, notation, program.step, 2);
  std::string code = "/*\n";
  for (const std::string& line : heading_lines(chain, program.precision))
    code += (line.empty() ? " *" : " * " + in_comment(line)) + "\n";
  code += " */\n#include <stdint.h>\n\n";
  for (const Constant& constant : program.constants)
    code += fmt::format("static const {} {} = {}; /* {} */\n", type, constant.name,
                        decimal(constant.value, notation), constant.meaning);
  code += "\ntypedef struct {\n" + members(program, Role::input) + "} controller_input;\n";
  code += "\ntypedef struct {\n" + members(program, Role::state) + "} controller_state;\n";
  code += functions(statements, type, decimal(0.0, notation));
  code += "\n/* Before the first sample. */\nvoid controller_start(controller_state* s) {\n";
  for (const Variable& variable : program.variables) {
    if (variable.role == Role::state)
      code +=
          fmt::format("  {} = {};\n", variable_text(variable, notation), initial_text(variable, notation));
  }
  code += fmt::format("}}\n\n/* The wanted {} ({}) at this sample. */\n",
                      parameters::text_on(chain.axis, "$torque"), parameters::unit_on(chain.axis, "N m"));
  code += fmt::format("{} controller_step(controller_state* s, const controller_input* in) {{\n", type);
  code += locals(program);
  if (statements.find("in->") == std::string::npos) code += "  (void)in;\n";
  code += statements;
  code += fmt::format("  return {};\n}}\n", program.variables[program.wanted].name);
  return code;
}

constexpr const char* plugin = R"(
#ifdef ZEROCOUNT_PLUGIN
#include <zerocount/controller.h>

static int plugin_start(void* state, const zerocount_setup* setup, char* message, size_t size) {{
  (void)setup, (void)message, (void)size;
  controller_start(state);
  return 0;
}}
static double plugin_step(void* state, const zerocount_setup* setup, const zerocount_sample* now) {{
  const controller_input in = {{{inputs}}};
  (void)setup;
  return (double)controller_step(state, &in);
}}
static const zerocount_controller description = {{
    sizeof description, ZEROCOUNT_CONTROLLER_ABI, "exported", "1", 0, 0, sizeof(controller_state),
    plugin_start,       plugin_step}};
const zerocount_controller* zerocount_controller_entry(void) {{ return &description; }}
#endif
)";

/// C initialisers for the inputs of the program, separated by commas.
/// @param from double-precision expressions, in the order of the inputs. For single precision, each is cast
/// to the type of its input, except flags.
std::string converted(const Program& program, const std::vector<std::string>& from) {
  std::string text;
  for (std::size_t i = 0; i < program.inputs(); ++i) {
    const Type type = program.variables[i].type;
    const bool single = program.precision == Precision::single_precision && type != Type::flag;
    text +=
        fmt::format("{}{}", text.empty() ? "" : ",\n                               ",
                    single ? fmt::format("({})({})", type_text(type, program.precision), from[i]) : from[i]);
  }
  return text;
}

constexpr const char* linuxcnc_head = R"comp(component {} "Position controller, as zerocount simulates it";
pin in bit enable "without it the {torque} is 0, and the controller starts anew";
pin in float target-counts "end of the move, counts";
pin in float command-counts "reference, which is rounded to counts";
pin in float feedback-counts "of the encoder, counts";
{}pin in float command-velocity "of the reference, {angle}/s";
pin in float command-acceleration "of the reference, {angle}/s2";
pin out float output-torque "wanted {torque}, {unit}";
function _ fp "one sample";
option data component_data;
license "GPL";
;;
)comp";

constexpr const char* linuxcnc_function = R"comp(
typedef struct {{
  controller_state chain;
  double given;  /* by the converter at the sample before, {unit} */
  double target; /* at the sample before, counts */
  int runs;
}} component_data;

static const double converter_step = {resolution};    /* {unit} */
static const double converter_lowest = {lowest};  /* {unit} */
static const double converter_highest = {highest}; /* {unit} */

static double nearest(double x) {{ return (x + 6755399441055744.0) - 6755399441055744.0; }}
static double given_for(double wanted) {{
  const double given = converter_step * nearest(wanted / converter_step);
  const double above = given < converter_lowest ? converter_lowest : given;
  return converter_highest < above ? converter_highest : above;
}}

FUNCTION(_) {{
  component_data* memory = &data;
  if (!enable) {{
    memory->runs = 0;
    output_torque = 0.0;
    return;
  }}
  if (!memory->runs) {{
    controller_start(&memory->chain);
    memory->given = 0.0;
    memory->target = target_counts;
    memory->runs = 1;
  }}
  const controller_input in = {{{inputs}}};
  const double wanted = controller_step(&memory->chain, &in);
  memory->target = target_counts;
  memory->given = given_for(wanted);
  output_torque = wanted;
}}
)comp";

}  // namespace

std::string c_code(const ControllerToWrite& chain, const Program& program) {
  return chain_code(chain, program) +
         fmt::format(plugin,
                     fmt::arg("inputs", converted(program, {"now->error", "now->count", "now->velocity",
                                                            "now->acceleration", "now->torque",
                                                            "now->new_target", "now->other_count"})));
}

std::string linuxcnc_component(const ControllerToWrite& chain, const Program& program,
                               const std::string& component) {
  const loop::DacParameters& dac = chain.dac;
  const Notation in_double = c_notation(Precision::double_precision);
  const std::string unit = parameters::unit_on(chain.axis, "N m");
  const auto torque_of = [&](std::int64_t code) {
    return decimal(static_cast<double>(code) * dac.resolution, in_double);
  };
  const std::string velocity_pin =
      chain.controller.velocity_by_other
          ? "pin in float velocity-feedback-counts \"of the encoder of the velocity loop, counts of it\";\n"
          : "";
  return fmt::format(linuxcnc_head, component, velocity_pin,
                     fmt::arg("torque", parameters::text_on(chain.axis, "$torque")),
                     fmt::arg("angle", parameters::unit_on(chain.axis, "rad")), fmt::arg("unit", unit)) +
         chain_code(chain, program) +
         fmt::format(
             linuxcnc_function, fmt::arg("resolution", decimal(dac.resolution, in_double)),
             fmt::arg("lowest", torque_of(loop::lowest_code(dac))),
             fmt::arg("highest", torque_of(loop::highest_code(dac))), fmt::arg("unit", unit),
             fmt::arg("inputs",
                      converted(program, {"nearest(command_counts) - feedback_counts", "feedback_counts",
                                          "command_velocity", "command_acceleration", "memory->given",
                                          "memory->target != target_counts", "velocity_feedback_counts"})));
}

}  // namespace zerocount::controller_code

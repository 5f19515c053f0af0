#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/controller_code/program.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/trials/variant.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* controller_help =
    "Writes the controller of a design point in a language without dependencies, one step a sample,\n"
    "with its constants by name and the margins of its loops in the heading.\n"
    "\n"
    "  --language c         one C99 file: its state in a struct, controller_start() and\n"
    "                       controller_step(). With -DZEROCOUNT_PLUGIN it is a plugin\n"
    "                       (docs/your-own-controller.md), so that the code that goes to the machine\n"
    "                       can be simulated itself\n"
    "  --language linuxcnc  a component of LinuxCNC's HAL, which halcompile installs; its name is\n"
    "                       that of the file\n"
    "  --language st        a function block in Structured Text (IEC 61131-3), named after the file\n"
    "\n"
    "Where conditions or ages change the controller, as a payload does its feed-forward, --condition\n"
    "and --age choose the one to write; its margins are then those of that condition.\n"
    "\n"
    "In double precision it computes the same bits as the simulation. With --precision single,\n"
    "trials of the point are simulated in both precisions, and what changes is printed and stands\n"
    "in the heading. The converter, its noise shaping among it, is not part of the file.\n"
    "\n"
    "Examples:\n"
    "  zerocount controller my-axis.yaml --point 2 -o controller.c\n"
    "  zerocount controller tuned.h5 --point best --language st --precision single -o axis.st\n";

/// Whether the written controller code depends on this input of the study.
bool is_in_code(const study::InputColumn& column) {
  constexpr std::array<std::string_view, 10> sections{"controller.",
                                                      parameter::dac::bits,
                                                      parameter::dac::resolution,
                                                      parameter::dac::range,
                                                      parameter::encoder::fine,
                                                      parameter::encoder::resolution,
                                                      parameter::encoder::load::counts_per_revolution,
                                                      parameter::encoder::load::resolution,
                                                      parameter::plant::load::encoder,
                                                      parameter::initial::integral};
  return std::ranges::any_of(sections, [&](std::string_view section) {
    return section.ends_with('.') ? column.name.starts_with(section) : column.name == section;
  });
}

/// Refuses a study in which values of the controller are drawn, because every machine would need other gains.
void require_values(const command_line::Arguments& arguments, const study::Study& study) {
  for (const study::InputColumn& column : study.columns.inputs) {
    if (is_in_code(column) && column.level != study::DrawLevel::study)
      arguments.refuse(
          fmt::format("{} is drawn, so that every machine has another controller; expected a "
                      "number (--set {}=…)",
                      column.name, column.name));
  }
}

/// Refuses a study in which values of the controller differ between conditions or ages, because each needs a
/// controller of its own.
void require_one_controller(const command_line::Arguments& arguments, const study::Study& study,
                            std::int64_t point) {
  std::vector<std::vector<double>> inputs;  // [setting]
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting)
    inputs.push_back(
        study::study_trial(study, point, study::trial_indices(study).trial_of(0, setting)).inputs);
  std::vector<std::string> differing;
  for (std::size_t column = 0; column < study.columns.inputs.size(); ++column) {
    if (!is_in_code(study.columns.inputs[column])) continue;
    std::vector<std::string> values;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (i == 0 || std::ranges::none_of(std::span(inputs).first(i), [&](const std::vector<double>& before) {
            return before[column] == inputs[i][column];
          }))
        values.push_back(fmt::format("{}{}", text::short_number(inputs[i][column]),
                                     study::setting_phrase(study.settings, static_cast<std::int64_t>(i))));
    }
    if (values.size() > 1)
      differing.push_back(
          fmt::format("{} is {}", study.columns.inputs[column].name, fmt::join(values, ", ")));
  }
  if (differing.empty()) return;
  arguments.refuse(
      fmt::format("the controllers of the conditions differ: {}; expected the one to write{}{}",
                  fmt::join(differing, "; "), study.settings.conditions.size() > 1 ? " with --condition" : "",
                  study.settings.ages.at.size() > 1
                      ? fmt::format("{} --age", study.settings.conditions.size() > 1 ? " and" : " with")
                      : ""));
}

/// Name of the output file without its ending, after which the written program is named.
/// @param what kind of the program, for the message: "a component"
/// @param fits whether a program of the language can have the name
/// @param example a file name that fits, for the message
std::string stem_of(const command_line::Arguments& arguments, const std::filesystem::path& output,
                    std::string_view what, bool (*fits)(std::string_view stem), std::string_view example) {
  std::string stem = output == "-" ? "controller" : output.stem().string();
  const bool is_word =
      !stem.empty() && std::isalpha(static_cast<unsigned char>(stem[0])) != 0 &&
      std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if (!is_word || !fits(stem))
    arguments.refuse(fmt::format(
        "option '--output': {} cannot have the name '{}'; expected a file whose name has letters, "
        "digits and _ alone, such as {}",
        what, stem, example));
  return stem;
}

std::string component_name(const command_line::Arguments& arguments, const std::filesystem::path& output) {
  return stem_of(
      arguments, output, "a component", [](std::string_view) { return true; }, "axis_x.comp");
}

/// Name of the function block, from the name of the output file. It has a suffix, because many words are
/// reserved in Structured Text.
std::string function_block_name(const command_line::Arguments& arguments,
                                const std::filesystem::path& output) {
  const auto fits = [](std::string_view stem) {
    return stem.find("__") == std::string_view::npos && !stem.ends_with('_');
  };
  const std::string stem = stem_of(arguments, output, "a function block", fits, "axis_x.st");
  return stem == "controller" ? "position_controller" : stem + "_controller";
}

/// Text of the smallest value of a stability margin over the examined trials.
/// @param none text if the range is empty
std::string margin_text(const theory::Range& margin, std::string_view unit, std::string_view none) {
  return margin.empty() ? std::string(none) : fmt::format("{:.3g} {}", margin.low, unit);
}

/// Lines of text on each control loop of the design point in each setting (condition at an age): its
/// stability, and its smallest gain and phase margins over the examined machines. A heading comes first;
/// empty if there is no loop.
std::vector<std::string> margin_lines(const study::Study& study, std::int64_t point) {
  std::vector<std::string> lines;
  std::vector<theory::KnownRotor> rotors;
  for (std::int64_t setting = 0; setting < study.settings.total(); ++setting) {
    for (const theory::LoopRanges& loop : theory::examine(study, point, setting, rotors).loops) {
      lines.push_back(fmt::format(
          "  {}{}: {}; gain margin {}, phase margin {}", loop.name,
          study::setting_phrase(study.settings, setting), theory::stability_text(loop),
          margin_text(loop.gain, "dB", loop.no_gain_stabilises ? theory::no_gain_text : "infinite"),
          margin_text(loop.phase, "deg", "infinite")));
    }
  }
  if (!lines.empty())
    lines.insert(lines.begin(),
                 "Loops by linear theory, with the smallest margins of the examined machines:");
  return lines;
}

std::vector<std::string> simulated_effect(const study::Study& study, std::int64_t point,
                                          const controller_code::ControllerToWrite& chain) {
  const status::InterruptionWatch interruption;
  try {
    return effect_of_single_precision(study, point, chain, interruption.token());
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

std::string written_text(const command_line::Arguments& arguments, const std::filesystem::path& output,
                         const controller_code::ControllerToWrite& chain,
                         controller_code::Precision precision) {
  const controller_code::Program program = controller_code::chain_program(chain, precision);
  const std::string language = arguments.choice("language");
  if (language == "linuxcnc")
    return controller_code::linuxcnc_component(chain, program, component_name(arguments, output));
  if (language == "st")
    return controller_code::structured_text(chain, program, function_block_name(arguments, output));
  return controller_code::c_code(chain, program);
}

ExitCode write_controller(const command_line::Arguments& arguments) {
  const std::string input = arguments.operands()[0];
  const std::filesystem::path output = command_line::text_place(arguments, "output").value_or("-");
  const study::Study whole = commands::load_study(input, arguments);
  const std::int64_t point = commands::study_point(arguments, whole).value_or(0);
  const study::Study study = trials::restricted_to(whole, arguments.value("condition"),
                                                   command_line::number_option(arguments, "age", 0.0));
  require_values(arguments, study);
  require_one_controller(arguments, study, point);
  const trial::TrialParameters p = study::study_trial(study, point, 0).parameters;
  if (!p.command.torque.levels.empty())
    arguments.refuse("the loop of this study is open: it has no controller");
  const auto precision = arguments.choice("precision") == "single"
                             ? controller_code::Precision::single_precision
                             : controller_code::Precision::double_precision;
  if (const std::string_view why = controller_code::why_not_writable(p.controller, precision); !why.empty())
    arguments.refuse(std::string(why));
  std::string name =
      study.points.labels.size() > 1
          ? fmt::format("{}, {}", study.name, study.points.labels[static_cast<std::size_t>(point)])
          : study.name;
  if (study.settings.total() == 1) name = study::label_under(name, study::label_of(study.settings, 0));
  controller_code::ControllerToWrite chain{p.controller,
                                           loop::fine_resolution(p.encoder),
                                           loop::velocity_resolution(p.encoder, p.controller),
                                           p.dac,
                                           trial::initial_integral(p),
                                           name,
                                           study.units.axis,
                                           margin_lines(study, point)};
  if (precision == controller_code::Precision::single_precision) {
    const std::vector<std::string> lines = simulated_effect(study, point, chain);
    for (const std::string& line : lines) status::tell("{}\n", line);
    chain.remarks.insert(chain.remarks.end(), lines.begin(), lines.end());
  }
  command_line::write_text(output, written_text(arguments, output, chain, precision));
  if (p.dac.sigma_delta)
    status::tell("the noise shaping of the converter (dac.sigma_delta) is not part of the controller\n");
  if (output != "-") status::tell("wrote {}\n", output.string());
  return ExitCode::success;
}

}  // namespace

commands::Command controller_command() {
  return {{"controller",
           "MANIFEST|FILE",
           {{"point", "P",
             "the design point, by label or number, or 'best' of a results file; default: the first"},
            command_line::written_file({"output,o", "FILE", "the file to write; default: standard output"}),
            {"condition", "NAME", "the condition whose controller it is, where the conditions have several"},
            {"age", "A", "the age whose controller it is, where the ages have several"},
            command_line::choice_option("language", "LANGUAGE", {"c", "linuxcnc", "st"}),
            command_line::choice_option("precision", "PRECISION", {"double", "single"}),
            {"set", "KEY=VALUE", "override a manifest key, e.g. controller.ki=3e-5; may be repeated", true},
            command_line::needing({"output"}, command_line::force_option())}},
          "write the controller of a point for a machine",
          controller_help,
          write_controller};
}

}  // namespace zerocount::study_commands

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/loop/encoder.hpp"
#include "experiments/study/study.hpp"
#include "runners/command_line/output_place.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/controller_code/c_code.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* controller_help =
    "Writes the controller of a design point as one C99 file without dependencies: its state in a\n"
    "struct, controller_start() and controller_step(). It computes the same bits as the simulation.\n"
    "\n"
    "With -DZEROCOUNT_PLUGIN the file is a plugin (docs/your-own-controller.md), so that the code\n"
    "that goes to the machine can be simulated itself. --language linuxcnc writes a component of\n"
    "LinuxCNC's HAL, which halcompile installs; its name is that of the file. The converter, its\n"
    "noise shaping among it, is not part of the file.\n"
    "\n"
    "Example: zerocount controller my-axis.yaml --point 2 -o controller.c\n";

/// Refuses a controller with drawn values, which has no gains of its own.
void require_values(const command_line::Arguments& arguments, const study::Study& study) {
  constexpr std::array<std::string_view, 6> sections{"controller.", "dac.bits",     "dac.resolution",
                                                     "dac.range",   "encoder.fine", "encoder.resolution"};
  for (const study::InputColumn& column : study.columns.inputs) {
    const bool counts = std::any_of(sections.begin(), sections.end(), [&](std::string_view section) {
      return section.ends_with('.') ? column.name.starts_with(section) : column.name == section;
    });
    if (counts && column.level != study::DrawLevel::study)
      arguments.refuse(
          fmt::format("{} is drawn, so that every machine has another controller; expected a "
                      "number (--set {}=…)",
                      column.name, column.name));
  }
}

/// The stem of the file, which a component has as its name.
std::string component_name(const command_line::Arguments& arguments, const std::filesystem::path& output) {
  std::string stem = output == "-" ? "controller" : output.stem().string();
  const bool fits =
      !stem.empty() && std::isalpha(static_cast<unsigned char>(stem[0])) != 0 &&
      std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
  if (!fits)
    arguments.refuse(
        fmt::format("option '--output': a component cannot have the name '{}'; expected a file "
                    "whose name has letters, digits and _ alone, such as axis_x.comp",
                    stem));
  return stem;
}

ExitCode write_controller(const command_line::Arguments& arguments) {
  const std::string input = arguments.operands()[0];
  const std::filesystem::path output = command_line::text_place(arguments, "output").value_or("-");
  const study::Study study = commands::load_study(input, arguments, std::span(&output, 1));
  const std::int64_t point = commands::study_point(arguments, study).value_or(0);
  require_values(arguments, study);
  const trial::TrialParameters p = study::study_trial(study, point, 0).parameters;
  if (!p.command.torque.levels.empty())
    arguments.refuse("the loop of this study is open: it has no controller");
  if (const std::string_view why = controller_code::why_not_writable(p.controller); !why.empty())
    arguments.refuse(std::string(why));
  const std::string name =
      study.points.labels.size() > 1
          ? fmt::format("{}, {}", study.name, study.points.labels[static_cast<std::size_t>(point)])
          : study.name;
  const controller_code::ControllerToWrite chain{p.controller, loop::fine_resolution(p.encoder), p.dac,
                                                 p.initial.integral, name};
  const bool linuxcnc = arguments.choice("language") == "linuxcnc";
  command_line::write_text(
      output, linuxcnc ? controller_code::linuxcnc_component(chain, component_name(arguments, output))
                       : controller_code::c_code(chain));
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
            {"output,o", "FILE", "the file to write; default: standard output"},
            command_line::choice_option("language", "LANGUAGE", {"c", "linuxcnc"}),
            {"set", "KEY=VALUE", "override a manifest key, e.g. controller.ki=3e-5; may be repeated", true},
            command_line::needing({"output"}, command_line::force_option())}},
          "write the controller of a point as C",
          controller_help,
          write_controller};
}

}  // namespace zerocount::study_commands

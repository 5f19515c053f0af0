#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/page.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/commands/timeline_option.hpp"
#include "runners/identification_commands/identification_commands.hpp"
#include "runners/status/status.hpp"

namespace zerocount::identification_commands {
namespace {

constexpr const char* identify_help =
    "Identifies the rotor and its friction from material tests: records of torque, angle and\n"
    "time before sliding, where a record ends. k1, k2 and beta come from slow loading and\n"
    "unloading, the damping and the inertia from the ringing after a step of the torque, alpha,\n"
    "lambda and n from creep at constant torque; all are fitted together, with 95 % confidence\n"
    "intervals. A record may have only some of these tests: parameters that it does not determine\n"
    "are listed with the reason. Several records must be tests of the same contact.\n"
    "\n"
    "A table (CSV) has the columns t (s), torque or drive_torque (N m), and theta (rad) or\n"
    "count, for which --counts-per-revolution is needed; 'zerocount trace' writes such tables.\n"
    "That of a linear axis has force or drive_force (N), and position (m) or count with\n"
    "--resolution; a trace of a linear axis needs --axis linear.\n"
    "--column names other columns and their units: QUANTITY=COLUMN, or QUANTITY=COLUMN[UNIT]\n"
    "with factors *NUMBER and /NUMBER that convert it, such as *0.87 for 0.87 N m/A.\n"
    "Quantities are time, torque or force, drive_torque or drive_force, angle or position, and\n"
    "repetition. COLUMN is a name in the header, #NUMBER, or the path of a dataset in an HDF5 or\n"
    "MAT file. A new repetition of the tests begins where the column of the repetition\n"
    "changes, or the time starts again.\n"
    "A results file has the traces of the trials that its manifest retains, of which all points\n"
    "of one axis are taken, unless --point chooses; the encoder's counts are used. At its first\n"
    "sample the contact must be unloaded and virgin, or have the state given by --preload and\n"
    "--hardening.\n"
    "\n"
    "--sliding takes motion records instead, in which the axis slides to and fro, under open or\n"
    "closed loop, and finds the inertia, the viscous damping, the Coulomb level and, if visible,\n"
    "the Stribeck curve, and torques that repeat with the position, such as gravity (on a linear axis\n"
    "with --pitch). It then simulates the axis under the recorded torque without a restart, and\n"
    "says how far it is from the record, what the unexplained torque repeats with, and how the\n"
    "friction turns over at reversals. command.torque.file in a manifest replays such a record.\n"
    "\n"
    "--model fits another friction law to the same tests (lugre, dahl, gms, spring), and --model all\n"
    "compares them by their residuals and by Schwarz's information criterion BIC, where a difference of\n"
    "10 is very strong evidence. A law must explain the records before BIC compares it.\n"
    "--series-compliance also fits the compliance of a fixture that yields under the torque.\n"
    "\n"
    "The output ends with the result as a fragment of a manifest; --format yaml prints only\n"
    "this. Its parameters are drawn independently; --posterior writes joint draws, for the key\n"
    "samples of a manifest. --plot draws each record with the fit, its residuals, and the torque\n"
    "over the angle: as a page (.html), or one record as a picture (.svg or .png), which needs node,\n"
    "and rsvg-convert for PNG (Debian: nodejs, librsvg2-bin). Records of sliding have no drawing yet:\n"
    "--plot and --sliding exclude each other.\n"
    "\n"
    "Unsuitable records are refused with the reason and exit code 4, files that are not such\n"
    "tables with exit code 2. The exit code is 3 if nothing can be identified, or if encoder and noise\n"
    "do not explain the residuals. With --sliding it is also 3 if the residuals depend on something\n"
    "that the law lacks (delay, speed, load, position, time), or if the motion has only one direction.\n"
    "\n"
    "Examples: zerocount identify ramps.csv steps.csv holds.csv --counts-per-revolution 1620000\n"
    "          zerocount identify tests.h5 --format yaml -o friction.yaml\n"
    "          zerocount identify tests.h5 --point 0 --point 1 --plot fit.html\n"
    "          zerocount identify log.txt --column time=t[ms] --column 'torque=I[A]*0.87' \\\n"
    "            --column 'angle=pos[mm]/10'\n";

/// Smallest value that a user may give for a known parameter, in its unit.
double min_known(fit::Coordinate coordinate) {
  if (coordinate == fit::time_offset) return -fit::max_time_offset;
  return coordinate == fit::creep_exponent ? 1.0 : std::numeric_limits<double>::min();
}

/// Parses a known parameter from the text "KEY=VALUE". Refuses other texts.
fit::KnownParameter known_parameter(const command_line::Arguments& arguments, const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const auto found = std::find(fit::coordinate_keys.begin(), fit::coordinate_keys.end(), key);
  if (equals == std::string::npos || found == fit::coordinate_keys.end()) {
    arguments.refuse(fmt::format("option '--fix': '{}' is not KEY=VALUE with KEY one of {}", text,
                                 fmt::join(fit::coordinate_keys, ", ")));
  }
  const auto coordinate = static_cast<fit::Coordinate>(found - fit::coordinate_keys.begin());
  const double value =
      command_line::number_from(arguments, "fix", text.substr(equals + 1), min_known(coordinate));
  if (coordinate == fit::time_offset && value > fit::max_time_offset) {
    arguments.refuse(
        fmt::format("option '--fix': a time offset of {:g} samples; expected {:g} to {:g}; "
                    "put a larger one into --delay",
                    value, -fit::max_time_offset, fit::max_time_offset));
  }
  return {coordinate, value};
}

fit::IdentificationOptions identification_options(const command_line::Arguments& arguments) {
  fit::IdentificationOptions options;
  for (const std::string& text : arguments.values("fix")) {
    options.known.push_back(known_parameter(arguments, text));
    const auto same = [&](const fit::KnownParameter& known) {
      return known.coordinate == options.known.back().coordinate;
    };
    if (std::any_of(options.known.begin(), options.known.end() - 1, same)) {
      arguments.refuse(fmt::format("option '--fix': '{}' is fixed twice", text.substr(0, text.find('='))));
    }
  }
  if (arguments.has("posterior")) {
    constexpr std::int64_t least = 1, most = 10'000, usual = 1000;
    options.draws = static_cast<std::size_t>(arguments.whole_number("draws", least, most).value_or(usual));
  }
  constexpr double least = 0.1;
  options.effort = command_line::number_option(arguments, "effort", least).value_or(1.0);
  return options;
}

/// Refuses a delay that is not a whole number of samples. Windows of sliding begin at samples, and so must
/// their torque.
void refuse_fractional_delay(const command_line::Arguments& arguments) {
  const std::optional<double> delay = delay_option(arguments);
  if (delay && *delay != std::floor(*delay)) {
    arguments.refuse(
        fmt::format("option '--delay': {:g} samples; expected a whole number with --sliding", *delay));
  }
}

sliding_identification::SlidingIdentification identify_sliding_axis(
    const command_line::Arguments& arguments) {
  const double pitch =
      command_line::number_option(arguments, "pitch", std::numeric_limits<double>::min()).value_or(0.0);
  std::vector<sliding_identification::SlidingRecord> found;
  for (const records::RawSeries& series : read_all_series(arguments)) {
    if (pitch > 0.0 && !series.linear)
      arguments.refuse(
          "option '--pitch' applies only to a linear axis; the torque of a rotary one repeats with each "
          "revolution");
    found.push_back(sliding_identification::sliding_record(series, pitch));
    if (found.back().axis != found.front().axis) {
      arguments.refuse("the records are of a linear and of a rotary axis; expected one axis");
    }
  }
  return sliding_identification::identify_sliding(std::move(found));
}

std::vector<fit::TestRecord> read_records(const command_line::Arguments& arguments) {
  std::vector<fit::TestRecord> found;
  for (const records::RawSeries& series : read_all_series(arguments)) {
    found.push_back(fit::checked_record(series, arguments.has("any-magnitude")));
  }
  return found;
}

std::vector<command_line::OptionSpec> law_options() {
  return {
      {"model", "LAW",
       fmt::format("friction law to fit, {} (default presliding), or all; may be repeated, to compare laws",
                   fmt::join(fit::law_words(), ", ")),
       true},
      {"series-compliance", "", "fit the compliance of a fixture in series with the contact, too"}};
}

/// Friction laws that the options ask to compare. None without these options, and for the pre-sliding model
/// alone, which has a fit of its own.
fit::LawChoice chosen_laws(const command_line::Arguments& arguments) {
  const std::vector<std::string> words = fit::law_words();
  std::vector<std::string> wanted;
  for (const std::string& word : arguments.values("model")) {
    if (word == "all") {
      wanted = words;
    } else if (std::find(words.begin(), words.end(), word) != words.end()) {
      wanted.push_back(word);
    } else {
      arguments.refuse(
          fmt::format("option '--model': '{}' is not one of {}, all", word, fmt::join(words, ", ")));
    }
  }
  fit::LawChoice choice{{}, arguments.has("series-compliance")};
  const std::string& usual = words.front();
  if (wanted.empty() && choice.series_compliance) wanted.push_back(usual);
  for (const std::string& word : words) {
    if (std::find(wanted.begin(), wanted.end(), word) != wanted.end())
      choice.laws.push_back(fit::law_of(word));
  }
  const bool presliding_alone = choice.laws.size() == 1 && wanted.front() == usual;
  if (presliding_alone && !choice.series_compliance) choice.laws.clear();
  return choice;
}

/// Refuses options that cannot be used when friction laws are compared.
void refuse_options_beside_laws(const command_line::Arguments& arguments) {
  for (const char* option : {"fix", "effort", "posterior", "plot"}) {
    if (!arguments.has(option)) continue;
    arguments.refuse(fmt::format(
        "option '--{}' is only for the pre-sliding model, without '--model' and '--series-compliance'",
        option));
  }
}

/// Exit code of an identification: success, or inconclusive with a message if no parameter is estimated or
/// the fit does not explain the records.
ExitCode identification_verdict(std::span<const fit::ParameterEstimate> parameters,
                                const fit::ResidualChecks& checks) {
  if (!checks.passed) {
    status::tell("zerocount identify: the result must not be trusted: {}\n", fit::reason_of_misfit(checks));
    return ExitCode::inconclusive;
  }
  if (std::ranges::any_of(parameters, fit::is_estimated)) return ExitCode::success;
  status::tell("zerocount identify: no parameter is identifiable from these records\n");
  return ExitCode::inconclusive;
}

fit::Identification identify_with_progress(const command_line::Arguments& arguments,
                                           std::vector<fit::TestRecord> records,
                                           fit::IdentificationOptions options) {
  commands::StageProgress progress("zerocount identify", arguments.has("quiet"));
  options.report = [&](std::string_view stage) { progress.enter(stage); };
  return fit::identify(std::move(records), options);
}

/// Paths of the output files and streams of the command; nothing: not written.
struct IdentifyOutputs {
  std::filesystem::path report;
  std::optional<std::filesystem::path> posterior;
  std::optional<std::filesystem::path> plot;
  commands::DrawingKind plot_kind{commands::DrawingKind::page};
  std::optional<std::filesystem::path> timeline{};
};

IdentifyOutputs identify_outputs(const command_line::Arguments& arguments) {
  IdentifyOutputs outputs{command_line::text_place(arguments, "output").value_or("-"),
                          command_line::text_place(arguments, "posterior"),
                          command_line::text_place(arguments, "plot")};
  for (const auto& other : {outputs.posterior, outputs.plot}) {
    if (other) command_line::require_apart(arguments, *other, {&outputs.report, 1});
  }
  if (outputs.plot) outputs.plot_kind = commands::drawing_kind(arguments, "plot", *outputs.plot);
  outputs.timeline = commands::timeline_place(arguments);
  return outputs;
}

/// Refuses a picture for several records, because it has room for only one.
void refuse_picture_of_several(const command_line::Arguments& arguments, const IdentifyOutputs& outputs,
                               std::size_t records) {
  if (!outputs.plot || outputs.plot_kind == commands::DrawingKind::page || records == 1) return;
  arguments.refuse(fmt::format(
      "option '--plot': a picture shows one record, but there are {}; write a page (.html)", records));
}

void write_draws(const fit::Identification& found, std::size_t wanted, const std::filesystem::path& place) {
  const std::string reason = fit::reason_of_missing_draws(found.draws, wanted);
  if (found.draws.rows.empty()) {
    status::tell("zerocount identify: {} is not written: {}\n", place.string(), reason);
    return;
  }
  if (!reason.empty()) status::tell("zerocount identify: {}: {}\n", place.string(), reason);
  command_line::write_text(place, fit::posterior_table(found));
}

document::AnswerDescription<fit::Identification> answer_with_figures() {
  document::AnswerDescription<fit::Identification> answer = fit::identification_answer();
  answer.items.figures(report::identification_figures);
  return answer;
}

/// Writes the answer in the format that the options ask for; as YAML, writes its fragment of a manifest.
/// @returns exit code of the answer
ExitCode write_answer(const command_line::Arguments& arguments, const IdentifyOutputs& outputs,
                      const document::Answer& answer, const std::string& fragment) {
  const std::string format = arguments.choice("format");
  if (format != "yaml" && yaml::is_standard_stream(outputs.report)) return answers::print(arguments, answer);
  command_line::write_text(outputs.report, format == "yaml" ? fragment : answers::rendered(answer, format));
  return answer.exit_code;
}

ExitCode write_identification(const command_line::Arguments& arguments, const IdentifyOutputs& outputs,
                              const fit::Identification& found, std::size_t wanted_draws) {
  const document::Answer answer =
      answer_with_figures().of(found, identification_verdict(found.parameters, found.checks));
  if (outputs.posterior) write_draws(found, wanted_draws, *outputs.posterior);
  if (outputs.plot)
    command_line::write_text(*outputs.plot,
                             commands::drawing(report::answer_page(answer), outputs.plot_kind));
  return write_answer(arguments, outputs, answer, found.fragment);
}

ExitCode identify_records(const command_line::Arguments& arguments, const IdentifyOutputs& outputs,
                          fit::IdentificationOptions options) {
  if (arguments.has("sliding")) {
    refuse_fractional_delay(arguments);
    const auto found = identify_sliding_axis(arguments);
    const std::string reason = sliding_identification::reason_of_distrust(found);
    if (!reason.empty()) status::tell("zerocount identify: the result must not be trusted: {}\n", reason);
    return write_answer(arguments, outputs,
                        sliding_identification::sliding_answer().of(
                            found, reason.empty() ? ExitCode::success : ExitCode::inconclusive),
                        found.fragment);
  }
  const fit::LawChoice choice = chosen_laws(arguments);
  if (!choice.laws.empty()) {
    refuse_options_beside_laws(arguments);
    std::vector<fit::TestRecord> records = read_records(arguments);
    commands::StageProgress progress("zerocount identify", arguments.has("quiet"));
    const auto compared =
        fit::compare_laws(std::move(records), choice, [&](std::string_view stage) { progress.enter(stage); });
    const fit::IdentifiedLaw& best = compared.laws.front();
    return write_answer(arguments, outputs,
                        fit::laws_answer().of(compared, identification_verdict(best.parameters, best.checks)),
                        best.fragment);
  }
  const std::size_t wanted_draws = options.draws;
  std::vector<fit::TestRecord> records = read_records(arguments);
  refuse_picture_of_several(arguments, outputs, records.size());
  return write_identification(arguments, outputs,
                              identify_with_progress(arguments, std::move(records), std::move(options)),
                              wanted_draws);
}

ExitCode identify(const command_line::Arguments& arguments) {
  fit::IdentificationOptions options = identification_options(arguments);
  const IdentifyOutputs outputs = identify_outputs(arguments);
  return commands::recorded(outputs.timeline, "identify",
                            [&] { return identify_records(arguments, outputs, std::move(options)); });
}

/// Option for records of material tests (torque, angle and time before sliding). Its help says that it is not
/// for records of sliding, and it is refused with --sliding.
command_line::OptionSpec of_tests(command_line::OptionSpec option) {
  option.help += "; not with --sliding";
  return command_line::excluding({"sliding"}, std::move(option));
}

std::vector<command_line::OptionSpec> identify_options() {
  std::vector<command_line::OptionSpec> options{
      {"counts-per-revolution", "N", "resolution of the encoder, for an angle in counts"},
      {"resolution", "SIZE", "size of a count, m (rad on a rotary axis), for a position in counts"},
      command_line::choice_option("axis", "AXIS", {"rotary", "linear"},
                                  "kind of axis of a table with the columns of zerocount trace")};
  const auto append = [&](const std::vector<command_line::OptionSpec>& more) {
    options.insert(options.end(), more.begin(), more.end());
  };
  append(column_options());
  for (command_line::OptionSpec& option : law_options()) options.push_back(of_tests(std::move(option)));
  append(
      {{"sliding", "", "identify inertia and sliding friction from motion records"},
       command_line::needing(
           {"sliding"},
           {"pitch", "LENGTH",
            "pitch of the screw or of the magnets of a linear axis, m, with which a force may repeat"}),
       {"angle", "COLUMN",
        "count, theta or position, if several exist (default count, if its size is given)"},
       {"torque", "COLUMN", "torque, drive_torque, force or drive_force, if several exist (default drive_…)"},
       {"amplifier-bandwidth", "HZ", "bandwidth of the amplifier (default 0: ideal amplifier)"},
       {"delay", "SAMPLES",
        "delay of the column torque, such as 1.5 (default 0); the time offset is fitted about it"},
       of_tests({"dac-bits", "BITS", "word length of the converter of the column code, to detect clipping"}),
       of_tests(
           {"preload", "TORQUE", "torque of a slow load and unload before the test, N m or N (default 0)"}),
       of_tests({"hardening", "XH", "work hardening before the test, rad or m (default 0)"}),
       of_tests({"fix", "KEY=VALUE",
                 "a known parameter, such as friction.n=2 or time_offset=0; may be repeated", true}),
       of_tests({"effort", "FACTOR",
                 "time for other starting points, if the first does not fit (default 1: about 20 s)"}),
       of_tests({"any-magnitude", "", "accept values that suggest other units"}),
       of_tests(command_line::written_file(
           {"posterior", "FILE", "write joint draws of the parameters there, for the key samples"})),
       command_line::needing({"posterior"},
                             {"draws", "N", "number of joint draws (default 1000, up to 10000)"}),
       of_tests(command_line::written_file(
           {"plot", "FILE",
            "draw the fit: a page of all records (*.html), or one record as *.svg or *.png"})),
       {"point", "P",
        "design point in a results file, by label or number (default: all with a trace); may be repeated",
        true},
       {"trial", "I", "trial of the point (default 0)"},
       answers::format_option({"yaml"}),
       command_line::written_file({"output,o", "FILE", "write there instead of to standard output"}),
       commands::timeline_option(),
       {"allow-equal", "", "take files with the same readings as records of different tests"},
       {"quiet,q", "", "print no progress"},
       command_line::needing({"output", "posterior", "plot"}, command_line::force_option())});
  return options;
}

}  // namespace

commands::Command identify_command() {
  return {{"identify", "DATA.csv|FILE...", identify_options(), 1, 64},
          "identify friction, damping and inertia from material tests",
          identify_help,
          identify,
          [] {
            return std::vector{fit::identification_answer().complete_type(),
                               fit::laws_answer().complete_type(),
                               sliding_identification::sliding_answer().complete_type()};
          }};
}

}  // namespace zerocount::identification_commands

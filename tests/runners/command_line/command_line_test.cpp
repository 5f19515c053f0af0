// The command line: help, usage errors, exit codes.
#include "runners/command_line/command_line.hpp"

#include <csignal>

#include "runners/program/commands.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/marked_text.hpp"

namespace zerocount::testing {
namespace {

using ::testing::Values;

class CommandLine : public ProgramTest {};

TEST_F(CommandLine, HelpGoesToStandardOutput) {
  const ProgramResult help = program({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* command :
       {"check", "run", "summary", "trace", "merge", "export", "parameters", "schema"}) {
    EXPECT_TRUE(says(help.out, command)) << command;
    const ProgramResult more = program({command, "--help"});
    EXPECT_EQ(more.code, 0) << command;
    EXPECT_TRUE(says(more.out, "usage: zerocount " + std::string(command))) << command;
    EXPECT_EQ(program({"help", command}).out, more.out);
  }
  EXPECT_EQ(program({"--version"}).code, 0);
}

TEST_F(CommandLine, BadUsageExitsWithTwoAndOneMessage) {
  folder_.write("study.yaml", small_manifest(2));
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"fly"},
      {"run"},
      {"run", "study.yaml"},
      {"run", "study.yaml", "-o"},
      {"run", "study.yaml", "-o", "a.h5", "-o", "b.h5"},
      {"run", "study.yaml", "-o", ""},
      {"run", "study.yaml", "-o", "a.h5", "--thread", "2"},
      {"run", "study.yaml", "-o", "a.h5", "--threads", "0"},
      {"run", "study.yaml", "-o", "a.h5", "--threads", "two"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "3/2"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "0/2"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "1"},
      {"run", "study.yaml", "-o", "a.h5", "--shard", "1/5"},
      {"run", "study.yaml", "more", "-o", "a.h5"},
      {"run", "study.yaml", "-o", "a.h5", "--set", "controller.kii=1"},
      {"run", "study.yaml", "-o", "a.h5", "--set", "controller.ki"},
      {"run", "study.yaml", "-o", "a.h5", "--quiet=yes"},
      {"check", "missing.yaml"},
      {"summary", "missing.h5"},
      {"summary", "study.yaml", "--format", "xml"},
      {"trace", "study.yaml", "--point", "2"},
      {"trace", "study.yaml", "--trial", "2"},
      {"trace", "study.yaml", "--trial", "-1"},
      {"trace", "missing.yaml"},
      {"merge", "missing.h5", "-o", "a.h5"},
      {"parameters", "study.yaml"},
  };
  for (const auto& words : cases) {
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 2) << ::testing::PrintToString(words) << result.err;
    EXPECT_FALSE(result.err.empty());
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_FALSE(says(result.err, "exception"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.h5"));
}

TEST_F(CommandLine, WrongOptionsAreRefusedWithTheReason) {
  EXPECT_TRUE(says(program({"run", "s.yaml", "-o", "a.h5", "--quiet=1"}).err, "'--quiet' takes no value"));
  EXPECT_TRUE(says(program({"run", "s.yaml", "-o"}).err, "needs a value"));
  EXPECT_TRUE(says(program({"run", "s.yaml", "--outptu", "a.h5"}).err,
                   "unknown option '--outptu'; did you mean --output?"));
}

TEST_F(CommandLine, UnusableDataExitsWithFour) {
  folder_.write("text.h5", "this is no HDF5 file, but it is long enough to look at\n");
  EXPECT_EQ(program({"summary", "text.h5"}).code, 4);
  EXPECT_EQ(program({"export", "text.h5", "-o", "csv"}).code, 4);
  EXPECT_EQ(program({"merge", "text.h5", "-o", "all.h5"}).code, 4);
}

TEST_F(CommandLine, ManifestErrorsAreAllReportedWithTheirPlace) {
  const MarkedText bad = marked_text(
      "zerocount: 1\nname: bad\nseed: 1\ntrials: 10\n«frictoin»: {k1: 3}\nfriction: {k1: «-5», n: «0.5»}\n"
      "command: {targets: [1], hold: «no»}\n");
  folder_.write("bad.yaml", bad.text);
  const ProgramResult result = program({"check", "bad.yaml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_TRUE(says(with_marks(result.err, "bad.yaml", bad), "bad.yaml:«1»: frictoin",
                   "bad.yaml:«2»: friction.k1", "bad.yaml:«3»: friction.n", "bad.yaml:«4»: command.hold"));
}

TEST_F(CommandLine, CheckPrintsThePlanAndTheCriteria) {
  folder_.write("study.yaml", "zerocount: 1\nname: machine\nseed: 1\ntrials: 10\ncommand: {targets: [5]}\n");
  const ProgramResult result = program({"check", "study.yaml"});
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* text : {"1 design point × 10 trials", "3.85e-05", "3.01e-04", "3.57e-05", "198"}) {
    const std::string short_form = std::string(text) == "3.01e-04" ? "0.000301" : text;
    EXPECT_TRUE(says(result.out, short_form)) << short_form << "\n" << result.out;
  }
}

TEST_F(CommandLine, CheckOmitsBoundsIfTheTheoryDoesNotApply) {
  const std::string head = "zerocount: 1\nname: machine\nseed: 1\ntrials: 10\n";
  folder_.write("open.yaml", head + "command: {torque: {levels: [0.1], through: exact}}\n");
  folder_.write("models.yaml", head + "command: {targets: [5]}\n" +
                                   "sweep: {grid: {friction.model: [coulomb, none, spring]}}\n");
  const std::string open = program({"check", "open.yaml"}).out;
  EXPECT_TRUE(says(open, "do not apply: the loop is open"));
  for (const char* bound : {"(6)", "(7)", "sampled loop", "DAC", "natural frequency", "N m/count"})
    EXPECT_FALSE(says(open, bound)) << bound;
  const auto theory_of = [this](const std::string& model) {
    return program({"check", "models.yaml", "--set", "sweep={grid: {friction.model: [" + model + "]}}"}).out;
  };
  const std::string of_coulomb = theory_of("coulomb"), of_none = theory_of("none");
  EXPECT_TRUE(says(of_coulomb, "friction.model coulomb has no spring"));
  EXPECT_TRUE(says(of_none, "friction.model none has no spring"));
  EXPECT_TRUE(std::regex_search(of_none, std::regex("sampled loop: +unstable\n"))) << of_none;
  EXPECT_FALSE(says(theory_of("spring"), "do not apply"));
}

// One count of the coarse encoder is 18.75 of the fine one: k1·Δx is 0.008 N m, not 4.27e-4.
TEST_F(CommandLine, CheckUsesTheEncoderThatIsFedBackForTheDacRule) {
  folder_.write("coarse.yaml",
                "zerocount: 1\nname: machine\nseed: 1\ntrials: 1\ncommand: {targets: [5]}\n"
                "controller: {encoder: coarse}\ndac: {resolution: 5.0e-4}\n");
  const auto theory =
      nlohmann::json::parse(program({"check", "coarse.yaml", "--format", "json"}).out)["theory"][0];
  EXPECT_EQ(theory["coarse_feedback"], true);
  EXPECT_NEAR(theory["dac_bound"]["low"].get<double>(), 0.008, 1e-4);
  EXPECT_EQ(theory["fine_enough"], theory["rule_trials"]);
}

// The loop of a published simulation.
TEST_F(CommandLine, CheckPredictsHuntingForEveryFrictionLaw) {
  folder_.write("machine.yaml",
                "zerocount: 1\nname: machine\naxis: linear\nseed: 1\ntrials: 1\n"
                "plant: {inertia: 1, presliding_damping: 0, sliding_damping: 0.4}\n"
                "friction: {model: lugre, sigma0: 1.0e+5, sigma1: 316, breakaway: 1.5, coulomb_ratio: 0.67, "
                "stribeck_velocity: 0.001}\n"
                "encoder: {resolution: 1.0e-7}\ndac: {bits: 24, resolution: 1.0e-6}\n"
                "controller: {units: si, sample_rate: 1000, kp: 3, ki: 4, kd: 6}\n"
                "command: {targets: [10000000], hold: 200}\n");
  for (const char* law : {"lugre", "coulomb"}) {
    const std::string out =
        program({"check", "machine.yaml", "--set", std::string("friction.model=") + law}).out;
    EXPECT_TRUE(std::regex_search(out, std::regex("hunting of trial 0: +amplitude 6\\.\\d+e\\+05 counts, "
                                                  "period 2[345]\\.")))
        << out;
  }
}

TEST_F(CommandLine, CheckHasARowPerPointAndStatesCommonValuesOnce) {
  folder_.write("sweep.yaml",
                "zerocount: 1\nname: machine\nseed: 1\ntrials: 3\ncommand: {targets: [5]}\n"
                "sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5, 3.0e-5]}}\n");
  const std::string out = program({"check", "sweep.yaml"}).out;
  EXPECT_EQ(out.find("natural frequency"), out.rfind("natural frequency: ")) << out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\npoint +integral gain +.*slowest move"))) << out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\npoint +loop +.*gain margin"))) << out;
  EXPECT_TRUE(says(out, "\nki=1e-05  1e-05 ", "\nki=2e-05  2e-05 ", "\nki=3e-05  3e-05 "));
}

TEST_F(CommandLine, APointIsNamedByItsNumberItsLabelOrTheLabelThatTablesShow) {
  folder_.write("grid.yaml",
                "zerocount: 1\nname: machine\nseed: 1\ntrials: 2\ncommand: {targets: [5], hold: 0.1}\n"
                "sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5], controller.kp: [0, 1.0e-4]}}\n");
  ASSERT_EQ(program({"run", "grid.yaml", "-q", "-o", "grid.h5"}).code, 0);
  const auto best_with = [&](const std::string& point) {
    return nlohmann::json::parse(
        program({"summary", "grid.h5", "--format", "json", "--point", point}).out)["best"]["point"];
  };
  EXPECT_EQ(best_with("2"), 2);
  EXPECT_EQ(best_with("controller.ki=2e-05, controller.kp=0"), 2);
  EXPECT_EQ(best_with("ki=2e-05 kp=0"), 2);
  EXPECT_EQ(program({"summary", "grid.h5", "--point", "kp=0"}).code, 2);
}

// At a k1 that is the same in all trials the sampled loop may still be stable in some trials only.
TEST_F(CommandLine, CheckJudgesTheSampledLoopOfEachTrial) {
  folder_.write("machine.yaml",
                "zerocount: 1\nname: machine\nseed: 1\ntrials: 20\ncommand: {targets: [5]}\n"
                "plant: {presliding_damping: {uniform: [0.1, 0.4]}}\n");
  const std::string out = program({"check", "machine.yaml"}).out;
  EXPECT_TRUE(std::regex_search(out, std::regex("sampled loop: +unstable in some trials\n"))) << out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\nat k1 +unstable in some trials "))) << out;
}

TEST_F(CommandLine, CheckCallsALoopWithoutRestoringTorqueMarginal) {
  folder_.write("machine.yaml",
                "zerocount: 1\nname: machine\nseed: 1\ntrials: 2\ncommand: {targets: [5]}\n"
                "controller: {ki: 0}\n");
  const std::string out = program({"check", "machine.yaml"}).out;
  EXPECT_TRUE(std::regex_search(
      out, std::regex("while sliding +marginal: a motion neither grows nor dies out within the hold")))
      << out;
}

TEST_F(CommandLine, CheckSeparatesTheCriteriaFromTheSampledLoop) {
  const std::string head = "zerocount: 1\nname: machine\nseed: 1\ntrials: 10\ncommand: {targets: [5]}\n";
  folder_.write("machine.yaml", head + "friction: {k1: 110}\n");
  const std::string between = program({"check", "machine.yaml", "--set", "controller.ki=3.8e-5"}).out;
  const std::string criteria = "by \\(6\\) and \\(7\\): +stable\nsampled loop: +";
  EXPECT_TRUE(std::regex_search(between, std::regex(criteria + "unstable\n"))) << between;
  const std::string low = program({"check", "machine.yaml", "--set", "controller.ki=1e-5"}).out;
  EXPECT_TRUE(std::regex_search(low, std::regex(criteria + "stable\n"))) << low;
  const std::string none = program({"check", "machine.yaml", "--set", "controller.ki=0"}).out;
  EXPECT_TRUE(std::regex_search(none, std::regex("integral: +none: the error stays"))) << none;
  EXPECT_TRUE(says(none, "slowest time constant")) << "the spring rings without an integral too";
}

TEST_F(CommandLine, ParametersAndSchemaComeFromTheSameTable) {
  const ProgramResult parameters = program({"parameters"});
  EXPECT_EQ(parameters.code, 0);
  EXPECT_TRUE(says(parameters.out, "friction.k1"));
  EXPECT_TRUE(says(program({"parameters", "--format", "markdown"}).out, "|"));
  const auto schema = nlohmann::json::parse(program({"schema"}).out);
  EXPECT_TRUE(schema["properties"].contains("friction"));
}

TEST_F(CommandLine, AFullStandardOutputExitsWithFive) {
  folder_.write("study.yaml", small_manifest(2));
  const std::string command =
      "cd " + folder_.path().string() + " && " ZEROCOUNT_PROGRAM " trace study.yaml > /dev/full 2> err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 5);
  EXPECT_TRUE(says(folder_.read("err"), "standard output"));
}

TEST_F(CommandLine, AnUnwritableStandardErrorStopsNothing) {
  folder_.write("study.yaml", small_manifest(20));
  for (const std::string to : {"2> /dev/full", "2>&-", "2>&1 | true"}) {
    const std::string command =
        "cd " + folder_.path().string() +
        " && rm -f a.h5 && { " ZEROCOUNT_PROGRAM " run study.yaml -o a.h5; echo $? > code; } " + to;
    std::system(command.c_str());
    EXPECT_EQ(folder_.read("code"), "0\n") << to;
    const ProgramResult summary = program({"summary", "a.h5"});
    EXPECT_EQ(summary.code, 0) << to << ": " << summary.err;
  }
}

// As any program that writes to a pipe: killed by the signal, without a message.
TEST_F(CommandLine, AClosedPipeEndsTheProgram) {
  const std::string command =
      "cd " + folder_.path().string() + " && { " ZEROCOUNT_PROGRAM " schema 2> err; echo $? > code; } | true";
  std::system(command.c_str());
  EXPECT_EQ(folder_.read("code"), fmt::format("{}\n", 128 + SIGPIPE));
  EXPECT_EQ(folder_.read("err"), "");
}

std::string name_of(const command_line::OptionSpec& option) {
  return option.name.substr(0, option.name.find(','));
}

/// The words of an option: "--name", followed by its values, if it takes any.
std::vector<std::string> given(const command_line::OptionSpec& option) {
  std::vector<std::string> words{"--" + name_of(option)};
  for (std::size_t i = 0; i < option.count && !option.value.empty(); ++i)
    words.push_back(option.words.empty() ? "1" : option.words.front());
  return words;
}

/// The message with which a command refuses these options beside enough operands; empty if it accepts them.
std::string refusal_of(const command_line::CommandSpec& spec, const std::string& first_operand,
                       const std::vector<const command_line::OptionSpec*>& options) {
  std::vector<std::string> words;
  for (const command_line::OptionSpec* option : options) {
    for (const std::string& word : given(*option)) words.push_back(word);
  }
  words.emplace_back("--");
  const std::size_t operands = std::min(spec.max_operands, std::max<std::size_t>(spec.min_operands, 1));
  for (std::size_t i = 0; i < operands; ++i) words.push_back(i == 0 ? first_operand : "x");
  return refusal_by([&] { command_line::Arguments(spec, words); });
}

/// The option that a condition of another option names.
const command_line::OptionSpec& option_of(const command_line::CommandSpec& spec,
                                          const std::string& condition) {
  const std::string name = condition.substr(0, condition.find('='));
  const auto found = std::ranges::find(spec.options, name, name_of);
  EXPECT_NE(found, spec.options.end()) << spec.name << ": " << condition;
  if (condition.find('=') != std::string::npos) {
    EXPECT_EQ(std::ranges::count(found->words, condition.substr(condition.find('=') + 1)), 1) << condition;
  }
  return *found;
}

// Each command says of which question an option is; elsewhere the option would have no effect.
TEST(OptionsWithoutEffect, AreErrorsOfEveryCommand) {
  int conditions = 0;
  for (const commands::Command& command : program::commands()) {
    const command_line::CommandSpec& spec = command.spec;
    const std::string usual = spec.operand_words.empty() ? "x" : spec.operand_words.front();
    for (const command_line::OptionSpec& option : spec.options) {
      const std::string own = "'--" + name_of(option) + "'";
      const std::string operand = option.operands.empty() ? usual : option.operands.front();
      if (!option.needs.empty()) {
        ++conditions;
        EXPECT_TRUE(says(refusal_of(spec, operand, {&option}), "option " + own + " needs '--"))
            << spec.name << own;
      }
      for (const std::string& need : option.needs) {
        std::vector<const command_line::OptionSpec*> all{&option, &option_of(spec, need)};
        for (const std::string& more : all.back()->needs) all.push_back(&option_of(spec, more));
        EXPECT_EQ(refusal_of(spec, operand, all), "") << spec.name << own << need;
      }
      for (const std::string& excluded : option.excludes) {
        ++conditions;
        std::vector<const command_line::OptionSpec*> all{&option, &option_of(spec, excluded)};
        for (const command_line::OptionSpec* one = &option; !one->needs.empty(); all.push_back(one))
          one = &option_of(spec, one->needs.front());
        EXPECT_TRUE(says(refusal_of(spec, operand, all), "exclude each other"))
            << spec.name << own << excluded;
      }
      for (const std::string& word : spec.operand_words) {
        const bool belongs = option.operands.empty() || std::ranges::count(option.operands, word) > 0;
        if (belongs) continue;
        ++conditions;
        EXPECT_TRUE(says(refusal_of(spec, word, {&option}), "does not apply to")) << spec.name << own << word;
      }
    }
  }
  EXPECT_GT(conditions, 30);
}

}  // namespace
}  // namespace zerocount::testing

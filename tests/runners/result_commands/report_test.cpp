#include "runners/child_process/child_process.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// Tests of the command `report` on the results of a small study.
class ReportCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    folder->write("a.yaml", small_manifest(30));
    ASSERT_EQ(run({"run", "a.yaml", "-o", "a.h5"}).code, 0);
  }
  static void TearDownTestSuite() { delete folder; }

  static ProgramResult run(const std::vector<std::string>& words) {
    return zerocount_program(words, folder->path());
  }

  static inline TemporaryFolder* folder = nullptr;
};

TEST_F(ReportCommand, IsReproducible) {
  const ProgramResult one = run({"report", "a.h5", "-o", "one.html"});
  ASSERT_EQ(one.code, 0);
  EXPECT_EQ(one.err, "");
  EXPECT_FALSE(std::filesystem::exists(*folder / "one.html.part"));
  ASSERT_EQ(run({"report", "a.h5", "-o", "two.html"}).code, 0);
  EXPECT_EQ(folder->read("one.html"), folder->read("two.html"));
}

/// The page gives the same verdict as the gate with the same margins.
TEST_F(ReportCommand, ComparesWithTheMarginsOfTheGate) {
  folder->write("gate.yaml", "require: success_rate ≥ 0.9999\n");
  EXPECT_EQ(run({"report", "a.h5", "-o", "m.html", "--margins", "gate.yaml"}).code, 2);
  const ProgramResult result =
      run({"report", "a.h5", "--baseline", "a.h5", "--margins", "gate.yaml", "-o", "m.html"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(says(folder->read("m.html"), "99.99 %"));
}

TEST_F(ReportCommand, WrongArgumentsAreRefusedWithTheReason) {
  EXPECT_EQ(run({"report", "a.h5"}).code, 2);
  EXPECT_EQ(run({"report", "none.h5", "-o", "x.html"}).code, 2);
  const ProgramResult point = run({"report", "a.h5", "-o", "x.html", "--point", "2"});
  EXPECT_EQ(point.code, 2);
  EXPECT_TRUE(says(point.err, "'2' is not a design point; expected a number from 0 to 1"));
  const ProgramResult place = run({"report", "a.h5", "-o", "nowhere/x.html"});
  EXPECT_EQ(place.code, 5);
  EXPECT_FALSE(std::filesystem::exists(*folder / "x.html"));
}

TEST_F(ReportCommand, PlotDrawsAFigure) {
  ProgramResult result = run({"plot", "a.h5", "--figure", "success", "-o", "a.svg"});
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string svg = folder->read("a.svg");
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_TRUE(says(svg, "success rate"));
  EXPECT_FALSE(says(svg, "var(--"));
  result = run({"plot", "a.h5", "--figure", "response", "-o", "a.png"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(folder->read("a.png").substr(1, 3), "PNG");
}

/// If all trials have the same friction, `check` prints no ranges, but the margins of the drawn trial.
TEST_F(ReportCommand, TheBodePlotHasTheMarginsOfCheck) {
  folder->write("margins.yaml",
                "zerocount: 1\nname: margins\nseed: 1\ntrials: 2\ncommand: {targets: [3], hold: 0.15}\n"
                "verdict: {dwell: 0.02, window: 0.02}\ncontroller: {kp: 3.0e-4, delay: 1}\n"
                "plant: {load: {inertia: 5.54e-4, stiffness: 2000, damping: 0.01}}\n");
  const auto checked = nlohmann::json::parse(run({"check", "margins.yaml", "--format", "json"}).out);
  ASSERT_EQ(run({"run", "margins.yaml", "-o", "margins.h5"}).code, 0);
  const ProgramResult drawn = run({"plot", "margins.h5", "--figure", "bode", "-o", "margins.svg"});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  const std::string svg = folder->read("margins.svg");
  const auto& loops = checked["theory"][0]["loops"];
  EXPECT_EQ(loops.size(), 3U);
  for (const auto& loop : loops) {
    const bool no_gain = loop["no_gain_stabilises"];
    std::string label =
        fmt::format("{}: {}, {:.3g}°", loop["loop"].get<std::string>(),
                    no_gain ? "no gain stabilises it"
                            : fmt::format("{:.3g} dB", loop["gain_margin"]["low"].get<double>()),
                    loop["phase_margin"]["low"].get<double>());
    for (std::size_t minus = label.find('-'); minus != std::string::npos; minus = label.find('-'))
      label.replace(minus, 1, "−");
    EXPECT_TRUE(says(svg, label)) << label;
  }
}

TEST_F(ReportCommand, WrongArgumentsOfPlotAreRefusedWithTheReason) {
  const ProgramResult unknown = run({"plot", "a.h5", "--figure", "sucess", "-o", "b.svg"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(says(unknown.err, "has: success, "));
  const ProgramResult extension = run({"plot", "a.h5", "--figure", "success", "-o", "b.jpg"});
  EXPECT_EQ(extension.code, 2);
  EXPECT_TRUE(says(extension.err, "does not end in .svg or .png"));
  EXPECT_EQ(run({"plot", "a.h5", "-o", "b.svg"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(*folder / "b.svg"));
}

TEST_F(ReportCommand, PlotWithoutNodeNamesThePackage) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder->path().c_str(), 1);
  const ProgramResult result = run({"plot", "a.h5", "--figure", "success", "-o", "c.svg"});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.code, 5);
  EXPECT_TRUE(says(result.err, "apt-get install nodejs"));
}

TEST(ChildProcess, PassesAnyAmountBothWays) {
  const std::string input(3'000'000, 'x');
  const std::optional<child_process::ChildResult> result =
      child_process::run_child({"sh", "-c", "cat; cat /dev/null; echo said >&2; exit 7"}, input);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->code, 7);
  EXPECT_EQ(result->out, input);
  EXPECT_EQ(result->err, "said\n");
}

TEST(ChildProcess, ReportsAMissingProgram) {
  EXPECT_FALSE(child_process::run_child({"zerocount-no-such-program"}, "").has_value());
}

TEST(ChildProcess, ReportsASignal) {
  EXPECT_EQ(child_process::run_child({"sh", "-c", "kill -9 $$"}, "")->code, 137);
}

// `report FOLDER`: an index of the results files in it, with the report of each.

class ReportIndex : public ProgramTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "site");
    std::filesystem::create_directories(folder_.path() / "runs");
  }
  void run_study(const std::string& name, const std::string& more) {
    folder_.write("study.yaml", "zerocount: 1\nname: " + name +
                                    "\nseed: 7\ntrials: 100\ncommand: {targets: [20], hold: 0.2}\n"
                                    "controller: {ki: 3.0e-5}\n" +
                                    more);
    ASSERT_EQ(program({"run", "study.yaml", "-o", "runs/" + name + ".h5", "-q"}).code, 0);
  }
  ProgramResult index(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"report", "runs", "-o", "site/index.html"};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
  bool exists(const std::string& path) const { return std::filesystem::exists(folder_.path() / path); }
};

TEST_F(ReportIndex, HasTheVerdictAndTheReportOfEachFile) {
  std::filesystem::create_directories(folder_.path() / "runs" / "begun.h5.shards");
  run_study("met", "goal: {band: 30, within: 0.15, moves: 0.9}\n");
  run_study("missed", "goal: {band: 0, within: 0.0001, moves: 0.9}\n");
  run_study("sums", "keep: statistics\n");
  folder_.write("runs/damaged.h5", "no results");
  const ProgramResult result = index();
  ASSERT_EQ(result.code, 0) << result.err;
  const std::string page = folder_.read("site/index.html");
  EXPECT_TRUE(says(page, "the goal is met", "the goal is missed", "href=\"./met.html\"",
                   "href=\"./missed.html\"", "begun.h5", "its run has not ended", "damaged.h5",
                   "5 results files", ">sums</td>"));
  EXPECT_FALSE(says(page, "sums.html"));
  EXPECT_FALSE(exists("site/sums.html"));
  EXPECT_TRUE(says(folder_.read("site/met.html"), "Requirements"));
}

TEST_F(ReportIndex, KeepsThePagesOfFilesThatHaveNotChanged) {
  run_study("one", "");
  ASSERT_EQ(index().code, 0);
  EXPECT_EQ(index().code, 2) << "the index exists";
  const auto written = std::filesystem::last_write_time(folder_.path() / "site/one.html");
  EXPECT_EQ(index({"--force"}).code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(folder_.path() / "site/one.html"), written);
}

// Copying a file, or unpacking an archive, can give a file of other trials an older time than its page has.
TEST_F(ReportIndex, RemakesThePagesOfChangedFilesWhateverTheirTimes) {
  run_study("one", "");
  ASSERT_EQ(index().code, 0);
  const std::string before = folder_.read("site/one.html");
  const auto written = std::filesystem::last_write_time(folder_.path() / "runs/one.h5");
  std::filesystem::remove(folder_.path() / "runs/one.h5");
  run_study("one", "sweep: {grid: {controller.kp: [0, 1.0e-4]}}\n");
  std::filesystem::last_write_time(folder_.path() / "runs/one.h5", written - std::chrono::hours(1));
  std::filesystem::remove(folder_.path() / "site/index.html");
  EXPECT_EQ(index().code, 2) << "an outdated page is not replaced without --force";
  EXPECT_EQ(folder_.read("site/one.html"), before);
  EXPECT_EQ(index({"--force"}).code, 0);
  EXPECT_NE(folder_.read("site/one.html"), before);
}

TEST_F(ReportIndex, RefusesOptionsOfASingleFileAndEmptyFolders) {
  const ProgramResult empty = index();
  EXPECT_EQ(empty.code, 2);
  EXPECT_TRUE(says(empty.err, "it has no results file"));
  const ProgramResult refused = index({"--with", "limits"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(says(refused.err, "option '--with': applies to one results file"));
}

// `report --with`: the answers of other commands as parts of the page.

/// The part of the page below the title of this section.
std::string section_in(const std::string& page, const std::string& name) {
  const std::size_t begin = page.find("<section id=\"" + name + "\">");
  if (begin == std::string::npos) return "there is no section " + name;
  const std::size_t title = page.find("</h2>\n", begin);
  return page.substr(title, page.find("</section>", title) - title);
}

class ReportParts : public ProgramTest {
 protected:
  void run_study(const std::string& more) {
    folder_.write("a.yaml",
                  "zerocount: 1\n"
                  "name: parts\n"
                  "seed: 7\n"
                  "trials: 120\n"
                  "command: {targets: [20], hold: 0.2}\n"
                  "controller: {ki: 8.0e-5}\n" +
                      more);
    ASSERT_EQ(program({"run", "a.yaml", "-o", "a.h5", "-q"}).code, 0);
  }

  /// The page that the command `report` writes with these options.
  std::string page(const std::vector<std::string>& more) {
    std::vector<std::string> words{"report", "a.h5", "-o", "-"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = program(words);
    EXPECT_EQ(result.code, 0) << result.err;
    told_ = result.err;
    return result.out;
  }

  std::string told_;
};

TEST_F(ReportParts, EqualTheAnswersOfTheirCommands) {
  run_study(
      "worlds: 6\n"
      "friction: {k1: {lognormal: {median: 130, cv: 0.2}}, alpha: {interval: [0.1, 2.0]}}\n"
      "initial: {encoder_phase: {uniform: [0, 1]}}\n"
      "goal: {band: 1, within: 0.05, moves: 0.9}\n");
  const std::string all = page({"--with", "all"});
  EXPECT_TRUE(says(told_, "the parts take at most "));
  for (const std::string name : {"limits", "worst", "learn"}) {
    const std::string alone = program({name, "a.h5", "--format", "html"}).out;
    EXPECT_EQ(section_in(all, name), section_in(alone, "answer"));
    EXPECT_TRUE(says(section_in(all, name), "class=\"headline\"")) << name;
  }
  const std::string rare = section_in(all, "rare");
  const std::size_t world = rare.find("In world ") + 9;
  const std::string alone = program({"rare", "a.h5", "-o", "rare.h5", "--format", "html", "--world",
                                     rare.substr(world, rare.find(',', world) - world)})
                                .out;
  const auto headline = [](const std::string& html) {
    const std::size_t begin = html.find("class=\"headline\"");
    return html.substr(begin, html.find("</div>", begin) - begin);
  };
  EXPECT_EQ(headline(rare), headline(section_in(alone, "answer")));
  EXPECT_LT(all.find("<section id=\"rare\">"), all.find("<section id=\"run\">"));
}

TEST_F(ReportParts, GiveTheReasonIfTheyAreMissing) {
  run_study("");
  const std::string without = page({"--with", "worst,learn,rare"});
  EXPECT_TRUE(says(without, "<section id=\"overview\">"));
  EXPECT_TRUE(says(section_in(without, "worst"), "Left out: "));
  EXPECT_TRUE(says(section_in(without, "learn"), "nothing differs between worlds"));
  EXPECT_TRUE(says(section_in(without, "rare"), "it draws nothing for each trial"));
  EXPECT_FALSE(says(without, "<section id=\"limits\">"));
  EXPECT_TRUE(
      says(section_in(page({"--with", "limits", "--budget", "10"}), "limits"), "the budget is not enough"));
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--with", "delay"}, {"--with", ""}, {"--budget", "10"}}) {
    std::vector<std::string> words{"report", "a.h5", "-o", "page.html"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(program(words).code, 2) << more.back();
  }
}

}  // namespace
}  // namespace zerocount::testing

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "runners/child_process/child_process.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

/// A folder with the results of a small study.
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

  static TemporaryFolder* folder;
};

TemporaryFolder* ReportCommand::folder = nullptr;

TEST_F(ReportCommand, WritesAPage) {
  const ProgramResult result = run({"report", "a.h5", "-o", "page.html"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string page = folder->read("page.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_FALSE(std::filesystem::exists(*folder / "page.html.part"));
}

TEST_F(ReportCommand, NothingThatIsReadIsWrittenOver) {
  const std::string before = folder->read("a.h5");
  std::filesystem::copy_file(*folder / "a.h5", *folder / "baseline.h5");
  for (const char* const output : {"a.h5", "baseline.h5", "/dev/null"}) {
    EXPECT_EQ(run({"report", "a.h5", "--baseline", "baseline.h5", "-o", output}).code, 2) << output;
  }
  EXPECT_EQ(folder->read("a.h5"), before);
  EXPECT_EQ(folder->read("baseline.h5"), before);
  std::filesystem::remove(*folder / "baseline.h5");
}

/// The page says what the gate says with the same margins.
TEST_F(ReportCommand, ComparesByTheMarginsOfTheGate) {
  folder->write("gate.yaml", "require: success_rate ≥ 0.9999\n");
  EXPECT_EQ(run({"report", "a.h5", "-o", "m.html", "--margins", "gate.yaml"}).code, 2);
  const ProgramResult result =
      run({"report", "a.h5", "--baseline", "a.h5", "--margins", "gate.yaml", "-o", "m.html"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(folder->read("m.html").find("99.99 %"), std::string::npos);
}

TEST_F(ReportCommand, IsTheSamePageEveryTime) {
  ASSERT_EQ(run({"report", "a.h5", "-o", "one.html"}).code, 0);
  ASSERT_EQ(run({"report", "a.h5", "-o", "two.html"}).code, 0);
  EXPECT_EQ(folder->read("one.html"), folder->read("two.html"));
}

TEST_F(ReportCommand, ComparesWithABaseline) {
  const ProgramResult result = run({"report", "a.h5", "--baseline", "a.h5", "-o", "compared.html"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(folder->read("compared.html").find("Against the baseline"), std::string::npos);
}

TEST_F(ReportCommand, SaysWhatIsWrongWithItsWords) {
  EXPECT_EQ(run({"report", "a.h5"}).code, 2);
  EXPECT_EQ(run({"report", "none.h5", "-o", "x.html"}).code, 2);
  const ProgramResult point = run({"report", "a.h5", "-o", "x.html", "--point", "2"});
  EXPECT_EQ(point.code, 2);
  EXPECT_NE(point.err.find("'2' is not a design point; expected a number from 0 to 1"), std::string::npos)
      << point.err;
  const ProgramResult place = run({"report", "a.h5", "-o", "nowhere/x.html"});
  EXPECT_EQ(place.code, 5);
  EXPECT_FALSE(std::filesystem::exists(*folder / "x.html"));
}

TEST_F(ReportCommand, PlotListsItsFigures) {
  const ProgramResult result = run({"plot", "a.h5"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("settling-time\n"), std::string::npos) << result.out;
}

TEST_F(ReportCommand, PlotDrawsAFigure) {
  ProgramResult result = run({"plot", "a.h5", "--figure", "success", "-o", "a.svg"});
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string svg = folder->read("a.svg");
  EXPECT_TRUE(svg.starts_with("<svg"));
  EXPECT_NE(svg.find("success rate"), std::string::npos);
  EXPECT_EQ(svg.find("var(--"), std::string::npos);
  result = run({"plot", "a.h5", "--figure", "response", "-o", "a.png"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(folder->read("a.png").substr(1, 3), "PNG");
}

/// With the same friction in all trials, check has no ranges but the margins of the trial that is drawn.
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
    std::string label =
        fmt::format("{}: {:.3g} dB, {:.3g}°", loop["loop"].get<std::string>(),
                    loop["gain_margin"]["low"].get<double>(), loop["phase_margin"]["low"].get<double>());
    for (std::size_t minus = label.find('-'); minus != std::string::npos; minus = label.find('-'))
      label.replace(minus, 1, "−");
    EXPECT_NE(svg.find(label), std::string::npos) << label;
  }
}

TEST_F(ReportCommand, PlotSaysWhatIsWrongWithItsWords) {
  const ProgramResult unknown = run({"plot", "a.h5", "--figure", "sucess", "-o", "b.svg"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("has: success, "), std::string::npos) << unknown.err;
  const ProgramResult extension = run({"plot", "a.h5", "--figure", "success", "-o", "b.jpg"});
  EXPECT_EQ(extension.code, 2);
  EXPECT_NE(extension.err.find("does not end in .svg or .png"), std::string::npos) << extension.err;
  EXPECT_EQ(run({"plot", "a.h5", "-o", "b.svg"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(*folder / "b.svg"));
}

TEST_F(ReportCommand, PlotWithoutNodeNamesThePackage) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder->path().c_str(), 1);
  const ProgramResult result = run({"plot", "a.h5", "--figure", "success", "-o", "c.svg"});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.code, 5);
  EXPECT_NE(result.err.find("apt-get install nodejs"), std::string::npos) << result.err;
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

TEST(ChildProcess, TellsWhereThereIsNoSuchProgram) {
  EXPECT_FALSE(child_process::run_child({"zerocount-no-such-program"}, "").has_value());
}

TEST(ChildProcess, TellsOfASignal) {
  EXPECT_EQ(child_process::run_child({"sh", "-c", "kill -9 $$"}, "")->code, 137);
}

}  // namespace
}  // namespace zerocount::testing

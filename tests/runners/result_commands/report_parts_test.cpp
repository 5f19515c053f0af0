// `report --with`: the answers of other commands as parts of the page.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

/// The page below the title of a section.
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

  /// The page of a report with these options.
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

TEST_F(ReportParts, AreTheAnswersOfTheirCommands) {
  run_study(
      "worlds: 6\n"
      "friction: {k1: {lognormal: {median: 130, cv: 0.2}}, alpha: {interval: [0.1, 2.0]}}\n"
      "initial: {encoder_phase: {uniform: [0, 1]}}\n"
      "goal: {band: 1, within: 0.05, moves: 0.9}\n");
  const std::string all = page({"--with", "all"});
  EXPECT_NE(told_.find("the parts take at most "), std::string::npos) << told_;
  for (const std::string name : {"limits", "worst", "learn"}) {
    const std::string alone = program({name, "a.h5", "--format", "html"}).out;
    EXPECT_EQ(section_in(all, name), section_in(alone, "answer"));
    EXPECT_NE(section_in(all, name).find("class=\"headline\""), std::string::npos) << name;
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

TEST_F(ReportParts, SayWhyTheyAreMissing) {
  run_study("");
  const std::string without = page({"--with", "worst,learn,rare"});
  EXPECT_NE(without.find("<section id=\"overview\">"), std::string::npos);
  EXPECT_NE(section_in(without, "worst").find("Left out: "), std::string::npos);
  EXPECT_NE(section_in(without, "learn").find("nothing differs between worlds"), std::string::npos);
  EXPECT_NE(section_in(without, "rare").find("it draws nothing for each trial"), std::string::npos);
  EXPECT_EQ(without.find("<section id=\"limits\">"), std::string::npos);
  EXPECT_NE(
      section_in(page({"--with", "limits", "--budget", "10"}), "limits").find("the budget is not enough"),
      std::string::npos);
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--with", "delay"}, {"--with", ""}, {"--budget", "10"}}) {
    std::vector<std::string> words{"report", "a.h5", "-o", "page.html"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(program(words).code, 2) << more.back();
  }
}

}  // namespace
}  // namespace zerocount::testing

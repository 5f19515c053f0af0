// Conditions in the commands on results: what a command says of a study under a condition is what it says of
// the study whose manifest has the overrides of the condition in its sections.

#include "results/reading/all_trials_file.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

using nlohmann::json;

const std::vector<std::string> names_of_conditions{"empty", "loaded"};

/// A study with two conditions ("both"), and two studies each of which has one of the conditions only.
struct Kind {
  std::string name;
  std::string head;   ///< text of the manifest without trials, plant and friction
  int trials;         ///< number of trials under each condition
  std::string goals;  ///< goals of the manifest; empty: the study is judged by success
};

const std::vector<Kind> kinds_with_conditions{
    {"machines",
     "machines: 24\nsweep: {grid: {controller.ki: [4.0e-5, 8.0e-5]}}\n"
     "command: {targets: [20, 5], hold: 0.06}\n",
     48,
     "goals:\n"
     "  large: {\"on\": [0], band: 1, within: 0.03, moves: 0.9}\n"
     "  small: {\"on\": [1], band: 1, within: 0.02, moves: 0.6, machines: 0.5}\n"},
    {"plain", "design: latin_hypercube\ncommand: {targets: [{integers: [1, 20]}], hold: 0.1}\n", 120, ""},
    {"worlds", "worlds: 5\nmachines: 10\ncommand: {targets: [12], hold: 0.1}\n", 50,
     "goal: {band: 0, within: 0.03, moves: 0.7}\n"}};

std::string manifest_of(const Kind& kind, int trials, const std::string& inertia, const std::string& k2,
                        const std::string& more) {
  const std::string level = kind.name == "worlds" ? "per: world" : "per: trial";
  return fmt::format(
      "zerocount: 1\nname: {}\nseed: 7\ntrials: {}\n{}verdict: {{dwell: 0.005, window: 0.01}}\n"
      "friction: {{k1: {{lognormal: {{median: 110, cv: 0.3}}, {}}}{}}}\n"
      "plant: {{inertia: {}}}\ninitial: {{encoder_phase: {{uniform: [0, 1]}}}}\n{}{}",
      kind.name, trials, kind.head, level, k2, inertia, kind.goals, more);
}

class ConditionsOfResults : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    const std::string light = "{uniform: [5.0e-4, 6.0e-4], per: trial}";
    const std::string heavy = "{uniform: [8.0e-4, 9.0e-4], per: trial}";
    for (const Kind& kind : kinds_with_conditions) {
      write(kind, "both",
            manifest_of(kind, 2 * kind.trials, light, "",
                        "conditions: {empty: {}, loaded: {friction.k2: 500, plant.inertia: "
                        "{uniform: [8.0e-4, 9.0e-4]}}}\n"));
      write(kind, "empty", manifest_of(kind, kind.trials, light, "", ""));
      write(kind, "loaded", manifest_of(kind, kind.trials, heavy, ", k2: 500", ""));
    }
  }
  static void TearDownTestSuite() { delete folder; }

  static std::string file_of(const Kind& kind, const std::string& study) { return kind.name + "-" + study; }

  static void write(const Kind& kind, const std::string& study, const std::string& manifest) {
    const std::string name = file_of(kind, study);
    folder->write(name + ".yaml", manifest);
    run({"run", name + ".yaml", "-o", name + ".h5", "--quiet"});
    run({"run", name + ".yaml", "-o", name + "-new.h5", "--quiet", "--set", "controller.kp=1.0e-4"});
  }
  /// The output of the program with these words, whatever verdict its exit code states.
  static std::string run(const std::vector<std::string>& words) {
    const ProgramResult result = zerocount_program(words, folder->path());
    const std::set<int> expected{0, 1, 3};  // said, missed or worse, undecided
    EXPECT_TRUE(expected.contains(result.code)) << words.front() << ": " << result.err;
    return result.out;
  }
  static json said(std::vector<std::string> words) {
    words.insert(words.end(), {"--format", "json"});
    return json::parse(run(words));
  }

  static inline TemporaryFolder* folder = nullptr;
};

/// The JSON answer without these members, at any depth.
json without(json answer, const std::set<std::string>& members) {
  if (answer.is_object()) {
    for (const std::string& member : members) answer.erase(member);
    for (auto& [key, value] : answer.items()) value = without(value, members);
  } else if (answer.is_array()) {
    for (json& value : answer) value = without(value, members);
  }
  return answer;
}

/// The design points of the JSON answer under one condition.
json under(const json& points, const std::string& condition) {
  json found = json::array();
  for (const json& point : points) {
    if (point.at("condition") != condition) continue;
    const std::string label = point.at(point.contains("label") ? "label" : "point");
    EXPECT_TRUE(label.ends_with(", " + condition)) << label;
    found.push_back(point);
  }
  return found;
}

TEST_F(ConditionsOfResults, CompareLikeSeparateStudies) {
  // The p of all tests are adjusted together, and what follows from them depends on their number.
  const std::set<std::string> of_all_tests{"label",
                                           "condition",
                                           "verdict",
                                           "gate",
                                           "adjusted_p",
                                           "adjusted_improvement_p",
                                           "detectable_change",
                                           "trials_to_decide",
                                           "decided_margin",
                                           "max_trials_margin",
                                           "note",
                                           "goal",
                                           "goals"};
  for (const Kind& kind : kinds_with_conditions) {
    const auto compared = [&](const std::string& study) {
      const std::string name = file_of(kind, study);
      return said({"compare", name + ".h5", name + "-new.h5"}).at("points");
    };
    const json both = compared("both");
    for (const std::string& condition : names_of_conditions) {
      const json alone = compared(condition);
      EXPECT_EQ(under(both, condition).size(), alone.size());
      EXPECT_EQ(without(under(both, condition), of_all_tests), without(alone, of_all_tests)) << kind.name;
      for (const json& point : alone) EXPECT_FALSE(point.contains("condition"));
    }
  }
}

TEST_F(ConditionsOfResults, AreMatchedByName) {
  folder->write("swapped.yaml",
                manifest_of(kinds_with_conditions[1], 40, "5.54e-4", "",
                            "conditions: {loaded: {friction.k2: 500, plant.inertia: {uniform: [8.0e-4, "
                            "9.0e-4]}}, empty: {}}\n"));
  folder->write("other.yaml", manifest_of(kinds_with_conditions[1], 40, "5.54e-4", "",
                                          "conditions: {empty: {}, hot: {}}\n"));
  for (const std::string name : {"swapped", "other"}) run({"run", name + ".yaml", "-o", name + ".h5", "-q"});
  const json matched = said({"compare", "plain-both.h5", "swapped.h5"}).at("points");
  EXPECT_EQ(under(matched, "loaded").size(), 1U);
  const ProgramResult lonely = zerocount_program({"compare", "plain-both.h5", "other.h5"}, folder->path());
  EXPECT_EQ(lonely.code, 4);
  EXPECT_TRUE(
      says(lonely.err, "not the same conditions; only plain-both.h5 has 'loaded'; only other.h5 has 'hot'"));
  EXPECT_EQ(zerocount_program({"compare", "plain-both.h5", "plain-empty.h5"}, folder->path()).code, 4);
}

TEST_F(ConditionsOfResults, UseTheMarginsAndRequirementsOfTheirPointAndGoal) {
  folder->write("gate.yaml",
                "margins: {goal_rate: 0.2, \"goal_rate[small]\": 0.3}\nrequire: [goal]\n"
                "points: {controller.ki=8e-05: {goal_rate: 0.4}}\n");
  const json points =
      said({"compare", "machines-both.h5", "machines-both-new.h5", "--margins", "gate.yaml"}).at("points");
  ASSERT_EQ(points.size(), 4U);
  for (const json& point : points) {
    const bool second = point.at("label").get<std::string>().starts_with("controller.ki=8e-05");
    for (const json& measure : point.at("measures")) {
      if (measure.at("measure") == "goal_rate[large]") {
        EXPECT_EQ(measure.at("margin"), second ? 0.4 : 0.2);
      }
      if (measure.at("measure") == "goal_rate[small]") {
        EXPECT_EQ(measure.at("margin"), second ? 0.4 : 0.3);
      }
    }
    ASSERT_EQ(point.at("requirements").size(), 2U);
    EXPECT_EQ(point.at("requirements")[0].at("quantity"), "goal[large]");
    EXPECT_EQ(point.at("requirements")[1].at("quantity"), "goal[small]");
  }
  folder->write("unknown.yaml", "margins: {\"goal_rate[medium]\": 0.3}\n");
  const ProgramResult unknown = zerocount_program(
      {"compare", "machines-both.h5", "machines-both-new.h5", "--margins", "unknown.yaml"}, folder->path());
  EXPECT_EQ(unknown.code, 2);
  EXPECT_TRUE(says(unknown.err, "'goal_rate[medium]'; expected one of its goals: large, small"));
}

TEST_F(ConditionsOfResults, HaveSensitivitiesAndJerksOfTheirOwn) {
  for (const Kind& kind : kinds_with_conditions) {
    for (const std::string command : {"sensitivity", "jerks"}) {
      const json both = said({command, file_of(kind, "both") + ".h5"}).at("points");
      for (const std::string& condition : names_of_conditions) {
        const json alone = said({command, file_of(kind, condition) + ".h5"}).at("points");
        const std::set<std::string> others{"label", "condition"};
        EXPECT_EQ(without(under(both, condition), others), without(alone, others)) << command << kind.name;
      }
    }
  }
}

TEST_F(ConditionsOfResults, AreNamedByVerdictsAndPlans) {
  EXPECT_TRUE(
      says(run({"judge", "machines-both.h5"}), ": the goal 'large' is missed under condition loaded\n"))
      << run({"judge", "machines-both.h5"});
  const std::string one_goal = said({"judge", "worlds-both.h5"}).at("headline");
  EXPECT_TRUE(says(one_goal, " under condition "));
  EXPECT_TRUE(says(run({"plan", "machines-both.yaml"}), "under the conditions empty, loaded together"));
}

TEST_F(ConditionsOfResults, ArePlannedLikeStudiesOfTheirOwn) {
  for (const Kind& kind : kinds_with_conditions) {
    const auto planned = [&](const std::string& study) {
      return said({"plan", file_of(kind, study) + ".yaml", "--margin", "arrival_time=20%", "--margin",
                   "success_rate=0.2"});
    };
    const json both = planned("both");
    std::size_t found = 0;
    for (const std::string& condition : names_of_conditions) {
      const json alone = planned(condition);
      EXPECT_EQ(both.at("pilot_trials"), 2 * alone.at("pilot_trials").get<std::int64_t>());
      // The trials depend on random numbers, of which each measure has its own.
      const std::set<std::string> others{"point", "condition", "trials"};
      const json mine = under(both.at("measures"), condition);
      EXPECT_EQ(without(mine, others), without(alone.at("measures"), others));
      if (condition == names_of_conditions.front()) {
        EXPECT_EQ(mine[0].at("trials"), 2 * alone.at("measures")[0].at("trials").get<std::int64_t>());
      }
      found += alone.at("measures").size();
    }
    EXPECT_EQ(both.at("measures").size(), found);
    ASSERT_TRUE(both.at("trials").is_number());
    EXPECT_EQ(both.at("trials").get<std::int64_t>() % (2 * (kind.name == "machines" ? 24 : 1)), 0);
    for (const json& one : both.at("measures")) EXPECT_LE(one.at("trials"), both.at("trials")) << one;
  }
}

// A measure of which a condition shows too little is named, not left out in silence.
TEST_F(ConditionsOfResults, AreNamedIfTheyCannotBePlanned) {
  folder->write("never.yaml", manifest_of(kinds_with_conditions[1], 240, "5.54e-4", "",
                                          "conditions: {empty: {}, loaded: {controller.ki: 0}}\n"));
  const json plan = said({"plan", "never.yaml", "--margin", "arrival_time=20%"});
  ASSERT_EQ(plan.at("unplanned").size(), 1U);
  EXPECT_EQ(plan.at("unplanned")[0].at("condition"), "loaded");
  EXPECT_TRUE(says(run({"plan", "never.yaml", "--margin", "arrival_time=20%"}), "Not planned: "));
}

TEST_F(ConditionsOfResults, PlanUsesTheConditionWhoseMachinesDifferMost) {
  double largest = 0.0;
  for (const std::string& condition : names_of_conditions) {
    const json alone = said({"plan", "--halfwidth", "0.05", "machines-" + condition + ".h5"}).at("halfwidth");
    largest = std::max(largest, alone.at("machine_sd").get<double>());
  }
  EXPECT_EQ(said({"plan", "--halfwidth", "0.05", "machines-both.h5"}).at("halfwidth").at("machine_sd"),
            largest);
}

TEST_F(ConditionsOfResults, HaveSeriesOfTheirOwn) {
  for (const Kind& kind : kinds_with_conditions) {
    const auto values_of = [&](const std::string& study) {
      const std::string name = file_of(kind, study);
      run({"history", "add", name + ".h5", "--database", name + ".sqlite"});
      std::map<std::pair<std::string, std::string>, json> values;
      for (const json& series : said({"history", "show", "--database", name + ".sqlite"}).at("series"))
        values[{series.at("point"), series.at("measure")}] =
            without(series.at("runs"), {"created", "trials", "study_sha256"});
      return values;
    };
    const auto both = values_of("both");
    std::size_t found = 0;
    for (const std::string& condition : names_of_conditions) {
      for (const auto& [place, runs] : values_of(condition)) {
        const auto mine = both.find({place.first + ", " + condition, place.second});
        ASSERT_NE(mine, both.end()) << place.first << place.second;
        EXPECT_EQ(mine->second, runs) << place.second;
        ++found;
      }
    }
    EXPECT_EQ(found, both.size());
  }
}

TEST_F(ConditionsOfResults, HaveCurvesOfTheirOwnInTheReport) {
  for (const Kind& kind : kinds_with_conditions) {
    const auto drawn = [&](const std::string& study, const std::string& figure) {
      const std::string name = file_of(kind, study);
      run({"plot", name + ".h5", "--figure", figure, "--point", "0", "-o", "figure.json", "--force"});
      const json data = json::parse(read_bytes(folder->path() / "figure.json")).at("datasets");
      return data.at(data.contains("steps") ? "steps" : "points");
    };
    std::vector<std::string> figures{"success"};
    if (kind.name == "machines") figures.emplace_back("settled");
    for (const std::string& figure : figures) {
      const json both = drawn("both", figure);
      for (const std::string& condition : names_of_conditions) {
        std::set<json> mine, theirs;
        for (const json& row : both)
          if (row.at("label").get<std::string>().ends_with(condition))
            mine.insert(without(row, {"label", "condition"}));
        for (const json& row : drawn(condition, figure)) theirs.insert(without(row, {"label", "condition"}));
        // A curve goes on to where the longest one of its goal ends, of two goals.
        EXPECT_TRUE(std::ranges::includes(mine, theirs)) << figure << " " << condition;
        EXPECT_LE(mine.size(), theirs.size() + 2);
      }
    }
  }
}

TEST_F(ConditionsOfResults, AreConfirmedTogether) {
  for (const Kind& kind : kinds_with_conditions) {
    const auto confirmed = [&](const std::string& study, int trials) {
      return said({"summary", file_of(kind, study) + ".h5", "--point", "0", "--confirm",
                   std::to_string(trials)})
          .at("confirmation");
    };
    const json both = confirmed("both", 2 * kind.trials);
    EXPECT_EQ(both.at("trials"), 2 * kind.trials);
    int successes = 0;
    for (const std::string& condition : names_of_conditions)
      successes += confirmed(condition, kind.trials).at("zero_count").get<int>();
    EXPECT_EQ(both.at("zero_count"), successes) << kind.name;
    EXPECT_TRUE(both.at("success_rate_low").is_null()) << "a machine has a trial under each condition";
  }
}

// What is to be learnt is whether the goal is met under all conditions.
TEST_F(ConditionsOfResults, AWorldThatIsBadUnderOneConditionIsBad) {
  const auto bad_of = [&](const std::string& study) {
    std::set<int> bad;
    const json worlds = said({"summary", "worlds-" + study + ".h5"}).at("points")[0].at("worlds");
    for (const json& world : worlds.at("bad_worlds")) bad.insert(world.get<int>());
    return bad;
  };
  std::set<int> any = bad_of("empty");
  any.merge(bad_of("loaded"));
  EXPECT_EQ(bad_of("both"), any);
  EXPECT_GT(any.size(), bad_of("empty").size());
  EXPECT_EQ(said({"learn", "worlds-both.h5"}).at("bad"), any.size());
}

// Memory and time of a study with a thousand conditions are not those of a thousand open files.
TEST(TrialsOfACondition, AreReadFromTheOpenFile) {
  const TemporaryFolder folder;
  folder.write("two.yaml",
               "zerocount: 1\nname: two\nseed: 7\ntrials: 40\ncommand: {targets: [3], hold: 0.05}\n"
               "initial: {encoder_phase: {uniform: [0, 1]}}\n"
               "conditions: {soft: {}, stiff: {controller.ki: 8.0e-5}}\n");
  zerocount_program({"run", "two.yaml", "-o", "two.h5", "--quiet"}, folder.path());
  const reading::AllTrialsFile file(folder / "two.h5");
  std::vector<double> errors = file.measure("final_error", file.rows());
  std::filesystem::remove(folder / "two.h5");
  std::vector<double> under_both;
  for (const std::int64_t condition : {0, 1}) {
    const reading::AllTrialsFile one = file.in_setting(condition);
    ASSERT_EQ(one.header().trials, 20);
    const std::vector<double> some = one.measure("final_error", one.rows());
    under_both.insert(under_both.end(), some.begin(), some.end());
  }
  std::ranges::sort(under_both);
  std::ranges::sort(errors);
  EXPECT_EQ(under_both, errors);
}

}  // namespace
}  // namespace zerocount::testing

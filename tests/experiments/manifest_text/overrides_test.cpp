#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/manifests/shipped_manifests.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::manifest_text {
namespace {

std::string override_failure(const std::vector<std::string>& overrides,
                             const std::string& text = minimal_manifest()) {
  return refusal_of(text, overrides);
}

TEST(Overrides, ReplaceAnyKey) {
  const study::Study study =
      study_of(full_manifest(), {"name=other", "seed=7", "trials=20", "design=sobol", "plant.inertia=1.0e-3",
                                 "command.targets.1=4", "friction.k2={uniform: [1, 2]}",
                                 "friction.k1.profile.cv=0.2", "sweep.cases.a.controller.ki=1.0e-5",
                                 "sweep.grid.plant.inertia=[2.0e-3]", "observed={a: new}"});
  EXPECT_EQ(study.name, "other");
  EXPECT_EQ(study.seed, 7u);
  EXPECT_EQ(study.trials, 20);
  EXPECT_EQ(study.design, study::Design::sobol);
  EXPECT_EQ(study::point_count(study), 4);
  EXPECT_EQ(study.profiles[0].profile->scale, std::sqrt(std::log1p(0.2 * 0.2)));
  const trial::TrialParameters parameters = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(parameters.plant.inertia, 2e-3);
  EXPECT_EQ(parameters.controller.ki, 1e-5);
  EXPECT_EQ(parameters.command.targets[1], 4);
  EXPECT_LT(parameters.friction.uniform.k2, 2);
}

TEST(Overrides, AddKeysAndWholeSections) {
  const study::Study study =
      study_of(minimal_manifest(), {"plant.inertia=2.0e-3", "sweep={grid: {controller.ki: [0, 1]}}",
                                    "sweep.grid.controller.kp=[0, 1, 2]", "retain.trials=[3]"});
  EXPECT_EQ(study::point_count(study), 6);
  EXPECT_EQ(study.retained_trials, std::vector<std::int64_t>{3});
  EXPECT_EQ(study::study_trial(study, 0, 0).parameters.plant.inertia, 2e-3);
}

TEST(Overrides, TheLastOneWins) {
  EXPECT_EQ(study_of(minimal_manifest(), {"trials=2", "trials=3"}).trials, 3);
}

TEST(Overrides, CanCorrectAManifest) {
  EXPECT_EQ(study_of("zerocount: 1\nname: x\nseed: 1\ntrials: none\ncommand: {targets: [1]}\n", {"trials=5"})
                .trials,
            5);
}

TEST(Overrides, KeepTheTextAndChangeTheHash) {
  const study::Study plain = study_of(minimal_manifest());
  const study::Study other = study_of(minimal_manifest(), {"trials=11"});
  EXPECT_EQ(other.manifest.text, minimal_manifest());
  EXPECT_EQ(other.manifest.sha256, plain.manifest.sha256);
  EXPECT_NE(other.study_sha256, plain.study_sha256);
  EXPECT_NE(other.study_sha256, study_of(minimal_manifest(), {"trials=12"}).study_sha256);
  EXPECT_EQ(other.manifest.overrides, std::vector<std::string>{"trials=11"});
}

TEST(Overrides, MistakesNameTheOverride) {
  EXPECT_TRUE(has_faults(override_failure({"plant.inertia=no"}),
                         "--set plant.inertia=no: plant.inertia | truth value"));
  EXPECT_TRUE(
      has_faults(override_failure({"plant.inertai=1"}), "--set plant.inertai=1: plant.inertai | inertia"));
  EXPECT_TRUE(has_faults(override_failure({"trials="}), "--set trials=: trials | the value is empty"));
  EXPECT_TRUE(has_faults(override_failure({"trials"}), "--set trials: manifest | override"));
  EXPECT_TRUE(has_faults(override_failure({"\xff\x1b[m"}), "--set \uFFFD\uFFFD[m: manifest | override"));
  EXPECT_TRUE(
      has_faults(override_failure({"plant..inertia=1"}), "--set plant..inertia=1: manifest | override"));
  EXPECT_TRUE(has_faults(override_failure({"zerocount=2"}), "--set zerocount=2: zerocount | version"));
  EXPECT_TRUE(has_faults(override_failure({"command.targets.3=2"}),
                         "--set command.targets.3=2: command.targets.3 | '3'"));
  EXPECT_TRUE(has_faults(override_failure({"trials.a=2"}), "--set trials.a=2: trials.a | neither"));
  EXPECT_EQ(override_failure({"trials=[1"}).rfind("--set trials=[1: manifest: ", 0), 0u);
  EXPECT_TRUE(has_faults(override_failure({"verdict.dwell=3"}),
                         "--set verdict.dwell=3: verdict.dwell | longer than the hold"));
}

TEST(Overrides, AnOverrideOfASweptKeyIsReported) {
  const auto report = [](const std::string& sweep, const std::string& change) -> std::string {
    yaml::Problems problems;
    std::deque<std::string> sources;
    const std::string text = "sweep: " + sweep;
    report_swept_overrides(*yaml::parse_yaml(text, "study.yaml", false, problems), {change}, sources,
                           problems);
    return refusal_by([&] { problems.raise_if_any(); });
  };
  const std::string grid = "{grid: {controller.ki: [1.0e-5, 2.0e-5]}}\n";
  EXPECT_TRUE(
      has_faults(report(grid, "controller.ki=3e-5"), "--set controller.ki=3e-5: controller.ki | sweep.grid"));
  EXPECT_EQ(report(grid, "controller={kp: 3e-5}"), "");
  EXPECT_NE(report("{grid: {friction.k1: [1, 2]}}\n", "friction.k1.uniform=[1, 2]"), "");
  EXPECT_EQ(report(grid, "controller.kp=3e-5"), "");
  EXPECT_EQ(report(grid, "controller.k=3e-5"), "");
  EXPECT_EQ(report(grid, "sweep.grid.controller.ki=[3e-5]"), "");
  const std::string all = "{cases: {a: {controller.ki: 1.0e-5}, b: {controller.ki: 2.0e-5}}}\n";
  EXPECT_TRUE(says(report(all, "controller.ki=3e-5"), "sweep.cases gives"));
  const std::string some = "{cases: {a: {controller.ki: 1.0e-5}, b: {controller.kp: 2.0e-5}}}\n";
  EXPECT_EQ(report(some, "controller.ki=3e-5"), "");
}

TEST(Overrides, MistakesAreReportedAfterThoseOfTheFile) {
  EXPECT_TRUE(has_faults(override_failure({"trials=0", "seed=x"}, minimal_manifest("plant: «1»\n")),
                         "«»: plant | '1'\n"
                         "--set seed=x: seed | is not a number\n"
                         "--set trials=0: trials | from 1 to 9007199254740992"));
}

// Overrides that are written into the text of a manifest.

/// Text of some numbers of the study's first trial, to compare studies; empty if the manifest with the
/// overrides is refused.
std::string essence_of(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    const study::Study study = manifest::parse_study(text, "manifest", overrides);
    const trial::TrialParameters p = study::study_trial(study, 0, 0).parameters;
    return fmt::format("{} {} {} {} {} {} {} {} {} {}", study.seed, study.trials, study::point_count(study),
                       p.controller.ki, p.controller.delay, p.plant.inertia, p.friction.uniform.k1,
                       p.friction.uniform.alpha, p.command.targets.size(), p.command.hold);
  } catch (const Failure&) {
    return "";
  }
}

// Whatever the manifest, the edited text is the study with the override, or there is none.
TEST(EditedText, EqualsTheOverride) {
  const std::vector<std::pair<std::string, std::string>> overrides{
      {"seed", "77"},
      {"trials", "12"},
      {"controller.delay", "0.5"},
      {"controller.ki", "1.25e-05"},
      {"friction.k1", "151"},
      {"friction.alpha", "0.002"},
      {"plant.inertia", "0.031"},
      {"initial.encoder_phase", "0.25"},
      {"command.targets", "[3, 4]"},
      {"command.hold", "0.4"},
      {"goal", "{band: 2, within: 0.1}"},
      {"retain.trials", "[0]"},
  };
  int edits = 0;
  for (const text::EmbeddedFile& file : manifests::shipped_manifests()) {
    const std::string text(file.bytes);
    for (const auto& [path, value] : overrides) {
      const std::optional<std::string> edited = with_override(text, path, value);
      if (!edited) continue;
      const std::string wanted = essence_of(text, {path + "=" + value});
      EXPECT_EQ(essence_of(*edited, {}), wanted) << file.name << ": " << path << "=" << value << "\n"
                                                 << *edited;
      edits += wanted.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(edits, 50);
}

TEST(EditedText, KeepsTheRestOfTheText) {
  EXPECT_EQ(with_override("a: 1  # one\nb: {c: 2, d: 3}\n", "b.c", "7"), "a: 1  # one\nb: {c: 7, d: 3}\n");
  EXPECT_EQ(with_override("a: {b: {uniform: [0, 1]}, c: 2}  # two\n", "a.b", "5"),
            "a: {b: 5, c: 2}  # two\n");
  EXPECT_EQ(with_override("a:\n  b: 1\n  c: 2\nd: 3\n", "a.e", "4"), "a:\n  e: 4\n  b: 1\n  c: 2\nd: 3\n");
  EXPECT_EQ(with_override("a:\n  b:\n    x: 1\n    y: 2\n  # of c\n  c: 2\n", "a.b", "5"),
            "a:\n  b: 5\n  # of c\n  c: 2\n");
  EXPECT_EQ(with_override("a: \"x # y\"\n", "a", "z"), "a: z\n");
  EXPECT_EQ(with_override("a: 1\n", "b.c", "2"), "a: 1\nb: {c: 2}\n");
}

TEST(EditedText, RefusesAnEditWithAnotherMeaning) {
  EXPECT_FALSE(with_override("a: &x {k: 1}\nb: *x\n", "b.k", "2")) << "a.k would change too";
  EXPECT_FALSE(with_override("a: [1, 2]\n", "a.0", "3"));
  EXPECT_FALSE(with_override("a: 1\n", "a.b", "3"));
  EXPECT_FALSE(with_override("{a", "a", "3"));
}

// What makes two manifests the same study: their values, and the order where that numbers something.

ManifestValues values(const std::string& text) {
  return values_of(text, "text", {});
}

std::string differences(const std::string& one, const std::string& other) {
  const std::string text = differences_text(manifest_differences(values(one), values(other)));
  // The hash of a study says the same.
  EXPECT_EQ(text.empty(), identity_text(values(one)) == identity_text(values(other))) << one << other;
  return text;
}

TEST(ManifestValues, DoNotDependOnHowTheyAreWritten) {
  const std::string text = "a: 1.50e-3\nlist: [1, 2.0, {x: 300}]\nmap: {b: 2, c: text}\n";
  for (const char* const other :
       {"# comment\na: 0.0015 # another\nlist: [1.0, 2, {x: 3.0e+2}]\nmap: {b: 2.0, c: text}\n",
        "a: 1.50e-3\r\nlist: [1, 2.0, {x: 300}]\r\nmap: {b: 2, c: text}\r\n",
        "map:\n  c: 'text'\n  b: 2\nlist:\n  - 1\n  - 2\n  - x: 300\na: 15.0e-4\n"})
    EXPECT_EQ(differences(text, other), "");
}

TEST(ManifestValues, AreComparedInAllDigits) {
  EXPECT_EQ(differences("seed: 9007199254740992\n", "seed: 9007199254740993\n"),
            "seed is 9007199254740992 there and 9007199254740993 here");
  EXPECT_EQ(differences("seed: 18446744073709551614\n", "seed: 18446744073709551615\n"),
            "seed is 18446744073709551614 there and 18446744073709551615 here");
  EXPECT_NE(differences("name: 1 a\n", "name: 1.0 a\n"), "");
}

TEST(ManifestValues, OrderMattersIfItNumbersPointsOrConditions) {
  EXPECT_EQ(differences("sweep: {grid: {x: [1, 2], y: [3, 4]}}\n", "sweep: {grid: {y: [3, 4], x: [1, 2]}}\n"),
            "sweep.grid, order of keys is x, y there and y, x here");
  EXPECT_NE(differences("conditions: {a: {}, b: {}}\n", "conditions: {b: {}, a: {}}\n"), "");
  // What has other keys has another order, which goes without saying.
  EXPECT_EQ(
      differences("sweep: {cases: {a: {x: 1}, b: {x: 2}}}\n", "sweep: {cases: {c: {x: 2}, a: {x: 1}}}\n"),
      "sweep.cases.b.x is 2 there, and not given here, sweep.cases.c.x is 2 here, and not given there");
}

// The results of one case stood under the name of another after an extension, where only the other number of
// trials was said.
TEST(ManifestValues, OrderIsComparedEvenIfOtherValuesDiffer) {
  for (const std::string map : {"sweep: {cases: {A, B}}", "sweep: {grid: {A, B}}", "conditions: {A, B}",
                                "goals: {A, B}", "tune: {free: {A, B}}"}) {
    const auto text = [&map](int trials, const std::string& first, const std::string& second) {
      std::string written = map;
      written.replace(written.find('A'), 1, first + ": [1, 2]");
      written.replace(written.find('B'), 1, second + ": [1, 2]");
      return fmt::format("trials: {}\n{}\n", trials, written);
    };
    SCOPED_TRACE(map);
    EXPECT_EQ(differences(text(1, "a", "b"), text(2, "a", "b")), "trials is 1 there and 2 here");
    const std::string found = differences(text(1, "a", "b"), text(2, "b", "a"));
    EXPECT_TRUE(says(found, ", order of keys is a, b there and b, a here", "trials is 1 there and 2 here"));
    // Names are not numbers of which two notations are equal.
    EXPECT_NE(differences(text(1, "'[1.0]'", "'[1]'"), text(1, "'[1]'", "'[1.0]'")), "");
  }
}

TEST(ManifestValues, TheOrderOfKeysDoesNotChangeTheHash) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < minimal_manifest().size();) {
    const std::size_t end = minimal_manifest().find('\n', at) + 1;
    lines.push_back(minimal_manifest().substr(at, end - at));
    at = end;
  }
  const study::Study plain = study_of(minimal_manifest());
  std::mt19937 random(4);
  for (int i = 0; i < 10; ++i) {
    std::ranges::shuffle(lines, random);
    std::string text = "# in another order\n";
    for (const std::string& line : lines) text += line;
    EXPECT_EQ(study_of(text).study_sha256, plain.study_sha256) << text;
  }
  EXPECT_EQ(study_of(minimal_manifest(), {"trials=" + std::to_string(plain.trials)}).study_sha256,
            plain.study_sha256);
}

}  // namespace
}  // namespace zerocount::manifest_text

// What makes two manifests the same study: their values, and the order where that numbers something.
#include "experiments/manifest_text/manifest_values.hpp"

#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::manifest_text {
namespace {

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

TEST(ManifestValues, HaveTheOrderOfWhatIsNumberedByIt) {
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
TEST(ManifestValues, HaveTheirOrderWhateverElseDiffers) {
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

TEST(ManifestValues, OfAManifestInAnotherOrderMakeTheSameHash) {
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

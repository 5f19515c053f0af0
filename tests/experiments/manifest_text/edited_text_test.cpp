// Overrides that are written into the text of a manifest.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/overrides.hpp"
#include "experiments/manifests/shipped_manifests.hpp"

namespace zerocount::manifest_text {
namespace {

/// Some numbers of the first trial of the study; empty if it cannot be made.
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
TEST(EditedText, MeansTheSameAsTheOverride) {
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

TEST(EditedText, KeepsAllElse) {
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

}  // namespace
}  // namespace zerocount::manifest_text

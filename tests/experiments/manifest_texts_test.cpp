// The expectations of messages about a manifest, on which many tests rest.
#include "tests/experiments/manifest_texts.hpp"

#include "tests/support/marked_text.hpp"

namespace zerocount {
namespace {

TEST(MarkedText, HasNoMarksAndTheirPlaces) {
  const MarkedText marked = marked_text("a: 1\nb: {c: «2», µ: «[«»3]»}\n«d»: 4\n");
  EXPECT_EQ(marked.text, "a: 1\nb: {c: 2, µ: [3]}\nd: 4\n");
  const std::vector<TextPlace> places{{2, 8}, {2, 15}, {2, 16}, {3, 1}};  // µ has two bytes
  EXPECT_EQ(marked.places, places);
  EXPECT_TRUE(marked_text("").places.empty());
  EXPECT_EQ(marked_text("Â µ").text, "Â µ");
}

TEST(MarkedText, RefusesAMarkWithoutItsOtherEnd) {
  EXPECT_THROW(marked_text("«a"), std::invalid_argument);
  EXPECT_THROW(marked_text("a»"), std::invalid_argument);
  EXPECT_THROW(marked_text("«a»»«"), std::invalid_argument);
}

TEST(MarkedText, StandsForPlacesInMessages) {
  const std::string message = "m.yaml:1:4: a: wrong\nm.yaml:1:1: b: gone\nother.yaml:1:4: a\nm.yaml:11:4: c";
  EXPECT_EQ(with_marks(message, "m.yaml", marked_text("a: «1»\n")),
            "m.yaml:«»: a: wrong\nm.yaml:1:1: b: gone\nother.yaml:1:4: a\nm.yaml:11:4: c");
  EXPECT_EQ(with_marks(message, "m.yaml", marked_text("«a»: «1»\n")),
            "m.yaml:«2»: a: wrong\nm.yaml:«1»: b: gone\nother.yaml:1:4: a\nm.yaml:11:4: c");
}

TEST(HasFaults, SeesAnotherPlaceKeyWordAndNumberOfFaults) {
  const std::string message = refusal_of(minimal_manifest("plant: {inertia: «heavy»}"));
  EXPECT_TRUE(has_faults(message, "«»: plant.inertia | is not a number"));
  EXPECT_FALSE(has_faults(message, "6:18: plant.inertia | is not a number"));
  EXPECT_FALSE(has_faults(message, "«»: plant | is not a number"));
  EXPECT_FALSE(has_faults(message, "«»: plant.inertia | is not a text"));
  EXPECT_FALSE(has_faults(message, "«»: plant.inertia | is not a number\n«»: plant.inertia | heavy"));
  EXPECT_FALSE(has_faults(message, ""));
  EXPECT_FALSE(has_faults("", "«»: plant.inertia | is not a number"));
  const std::string besides = refusal_of(minimal_manifest("plant: {«inertia»: heavy}"));
  EXPECT_FALSE(has_faults(besides, "«»: plant.inertia | is not a number"));
  EXPECT_TRUE(has_faults(besides, "6:18: plant.inertia | is not a number"));
}

TEST(HasFaults, SeesTheMarksOfWarnings) {
  const study::Study study = study_of(minimal_manifest("friction: {k2: 0, beta: «2.0e+5»}\n"));
  EXPECT_TRUE(has_faults(study.warnings, "«»: friction.beta | no effect"));
}

}  // namespace
}  // namespace zerocount

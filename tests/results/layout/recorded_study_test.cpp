// The study of a results file, by its manifest and overrides, has the trials that the file has.
#include <gtest/gtest.h>

#include "results/layout/header.hpp"
#include "tests/results/failures.hpp"

namespace zerocount::testing {
namespace {

layout::FileHeader header_of(std::int64_t points, std::int64_t trials) {
  layout::FileHeader header;
  header.manifest =
      "zerocount: 1\nname: recorded\nseed: 1\ntrials: 2\ncommand: {targets: [1], hold: 0.5}\n"
      "sweep: {grid: {controller.kp: [0, 1.0e-4, 2.0e-4]}}\n";
  header.points = points;
  header.trials = trials;
  return header;
}

TEST(RecordedStudy, HasTheTrialsOfTheFile) {
  EXPECT_EQ(study::trial_count(layout::recorded_study(header_of(3, 2), "study.h5")), 6);
}

// Statistics of the trials of a file by another study wrote beyond the end of their vectors.
TEST(RecordedStudy, OfOtherTrialsThanThoseOfTheFileIsRefused) {
  layout::FileHeader more = header_of(3, 2);
  more.overrides = {"trials=4"};
  expect_failure(ExitCode::bad_data,
                 "study.h5: damaged: it has 3 design points with 2 trials each; its manifest and overrides "
                 "have 3 with 4",
                 [&] { layout::recorded_study(more, "study.h5"); });
  expect_failure(ExitCode::bad_data, "it has 4 design points with 2 trials each",
                 [&] { layout::recorded_study(header_of(4, 2), "study.h5"); });
}

}  // namespace
}  // namespace zerocount::testing

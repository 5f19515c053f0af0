// The reference against a linear programme that knows nothing of segments: in the time of a move no other
// motion within the limits goes farther.
#include "core/loop/reference.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::loop {
namespace {

/// The longest travel in the time and within the limits of each line "duration velocity acceleration jerk".
std::vector<double> longest_travels(const std::string& lines) {
  const testing::TemporaryFolder folder;
  const std::string input = folder.write("moves", lines).string();
  const std::string output = (folder / "travels").string();
  const std::string command =
      fmt::format("{} -B '{}' '{}' > '{}'", ZEROCOUNT_PYTHON, ZEROCOUNT_JUDGE_SCRIPT, input, output);
  if (std::system(command.c_str()) != 0) ADD_FAILURE() << "failed (scipy is needed): " << command;
  std::istringstream stream(folder.read("travels"));
  std::vector<double> travels;
  for (double travel = 0.0; stream >> travel;) travels.push_back(travel);
  return travels;
}

TEST(ReferenceJudge, NoMotionWithinTheLimitsIsFaster) {
  // Travels of 1 rad; limits around those with which each is just reached, so that all cases occur.
  constexpr std::int64_t counts = 1'000'000'000;
  constexpr double resolution = 1e-9;
  std::mt19937_64 random(1);
  const auto about = [&random](double middle) {
    return middle * std::pow(10.0, std::uniform_real_distribution<double>(-0.7, 0.7)(random));
  };
  std::string lines;
  for (int i = 0; i < 60; ++i) {
    const bool trapezoidal = i % 4 == 0;
    const ReferenceProfile profile{trapezoidal ? ReferenceShape::trapezoidal : ReferenceShape::s_curve,
                                   about(1.0), about(2.0), about(10.0)};
    const Reference reference(profile, 0, counts, resolution);
    lines +=
        fmt::format("{} {} {} {}\n", reference.duration(), profile.velocity_limit, profile.acceleration_limit,
                    trapezoidal ? std::string("inf") : fmt::format("{}", profile.jerk_limit));
  }
  const std::vector<double> travels = longest_travels(lines);
  ASSERT_EQ(travels.size(), 60u);
  // The judge may fall short, because it changes jerk or acceleration only at the ends of 240 steps.
  for (std::size_t i = 0; i < travels.size(); ++i) {
    EXPECT_LE(travels[i], 1.0 + 1e-6) << "move " << i << " could be faster";
    EXPECT_GE(travels[i], 1.0 - 2e-3) << "move " << i << " is impossible within its limits";
  }
}

}  // namespace
}  // namespace zerocount::loop

#include "experiments/study/point_label.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

const std::vector<std::string> labels{"controller.kp=0, controller.ki=5000",
                                      "controller.kp=0, controller.ki=1e+04", "a b, controller.coarse.kp=1",
                                      "2 c", "1"};

TEST(PointLabel, IsTheLabelTheNumberOrWhatTablesShow) {
  for (const char* const name : {"controller.kp=0, controller.ki=5000", "0", "kp=0 ki=5000", "kp=0, ki=5000",
                                 "0 (kp=0 ki=5000)", "controller.kp=0 controller.ki=5000"})
    EXPECT_EQ(study::point_named(name, labels), 0) << name;
  EXPECT_EQ(study::point_named("a b kp=1", labels), 2);
  EXPECT_EQ(study::point_named("a b coarse.kp=1", labels), 2);
  EXPECT_EQ(study::point_named("3", labels), 3);
  EXPECT_EQ(study::point_named("1", labels), 4);  // a label before a number
}

TEST(PointLabel, NamesOnePointOrNone) {
  for (const char* const name : {"", "5", "-1", "ki=5000", "1 (kp=0 ki=5000)", "9 (kp=0 ki=5000)", "kp=0"})
    EXPECT_EQ(study::point_named(name, labels), std::nullopt) << name;
  const std::vector<std::string> alike{"controller.kp=1", "controller.coarse.kp=1"};
  EXPECT_EQ(study::point_named("kp=1", alike), std::nullopt);
  EXPECT_EQ(study::point_named("coarse.kp=1", alike), 1);
  EXPECT_EQ(study::point_named("oarse.kp=1", alike), std::nullopt);
}

}  // namespace
}  // namespace zerocount::testing

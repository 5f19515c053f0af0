// The end of a slide within a step of its series.
#include "core/friction/sliding/sliding.hpp"

#include <gtest/gtest.h>

namespace zerocount::friction {
namespace {

SlidingSeries with_velocity(std::initializer_list<double> coefficients) {
  SlidingSeries series{};
  std::size_t k = 0;
  for (const double coefficient : coefficients) series.omega[k++] = coefficient;
  return series;
}

TEST(SlidingEvent, IsTheFirstZeroOfTheVelocity) {
  const auto next = Slide::first_event(with_velocity({2.0, -1.0}), 5.0);
  EXPECT_EQ(next.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(next.time, 2.0);
  EXPECT_EQ(Slide::first_event(with_velocity({2.0, -1.0}), 1.5).event, Slide::Event::none);
}

TEST(SlidingEvent, IsNotTheRestFromWhichTheSlideStarts) {
  EXPECT_EQ(Slide::first_event(with_velocity({0.0, 1.0}), 5.0).event, Slide::Event::none);
  const auto back = Slide::first_event(with_velocity({0.0, 3.0, -1.0}), 5.0);
  EXPECT_EQ(back.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(back.time, 3.0);
  // Released at the very level by a torque that moves: the acceleration, too, starts at zero.
  const auto released = Slide::first_event(with_velocity({0.0, 0.0, 4.0, -1.0}), 5.0);
  EXPECT_EQ(released.event, Slide::Event::velocity_zero);
  EXPECT_DOUBLE_EQ(released.time, 4.0);
  EXPECT_EQ(Slide::first_event(with_velocity({}), 5.0).event, Slide::Event::none);
}

}  // namespace
}  // namespace zerocount::friction

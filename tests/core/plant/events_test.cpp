// The end of a slide within a step of its series.
#include "core/plant/events.hpp"

#include <gtest/gtest.h>

namespace zerocount {
namespace {

SlidingSeries with_velocity(std::initializer_list<double> coefficients) {
  SlidingSeries series{};
  std::size_t k = 0;
  for (const double coefficient : coefficients) series.omega[k++] = coefficient;
  return series;
}

TEST(SlidingEvent, IsTheFirstZeroOfTheVelocity) {
  const NextEvent next = next_sliding_event(with_velocity({2.0, -1.0}), 5.0);
  EXPECT_EQ(next.event, Event::velocity_zero);
  EXPECT_DOUBLE_EQ(next.time, 2.0);
  EXPECT_EQ(next_sliding_event(with_velocity({2.0, -1.0}), 1.5).event, Event::none);
}

TEST(SlidingEvent, IsNotTheRestFromWhichTheSlideStarts) {
  EXPECT_EQ(next_sliding_event(with_velocity({0.0, 1.0}), 5.0).event, Event::none);
  const NextEvent back = next_sliding_event(with_velocity({0.0, 3.0, -1.0}), 5.0);
  EXPECT_EQ(back.event, Event::velocity_zero);
  EXPECT_DOUBLE_EQ(back.time, 3.0);
  // Released at the very level by a torque that moves: the acceleration, too, starts at zero.
  const NextEvent released = next_sliding_event(with_velocity({0.0, 0.0, 4.0, -1.0}), 5.0);
  EXPECT_EQ(released.event, Event::velocity_zero);
  EXPECT_DOUBLE_EQ(released.time, 4.0);
  EXPECT_EQ(next_sliding_event(with_velocity({}), 5.0).event, Event::none);
}

}  // namespace
}  // namespace zerocount

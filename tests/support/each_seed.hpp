#pragma once

#include "tests/support/test.hpp"

/// TEST_EACH_SEED(Fixture, Name) { body }: the test Fixture.Name, which runs the body as a member function of
/// Fixture(seed) with each seed from 1 to Fixture::seeds. One CTest test instead of one per seed, most of
/// whose time would be the start of a process.
#define TEST_EACH_SEED(Fixture, Name)                         \
  struct Fixture##_##Name : Fixture {                         \
    using Fixture::Fixture;                                   \
    void check();                                             \
  };                                                          \
  TEST(Fixture, Name) {                                       \
    for (unsigned seed = 1; seed <= Fixture::seeds; ++seed) { \
      SCOPED_TRACE(::testing::Message() << "seed " << seed);  \
      Fixture##_##Name(seed).check();                         \
    }                                                         \
  }                                                           \
  void Fixture##_##Name::check()

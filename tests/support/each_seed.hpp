#pragma once

#include "tests/support/test.hpp"

/// Macro for a test with random data: TEST_EACH_SEED(Fixture, Name) { body } defines the test Fixture.Name.
/// It runs the body as a member function of Fixture(seed) with each seed from 1 to Fixture::seeds. This is
/// one CTest test, because with one test per seed most of the time would be spent on starting processes.
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

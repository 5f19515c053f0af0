// Headers of libraries that most tests need, parsed once for all of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "precompiled.hpp"

// What precompiled.hpp is to the product, for tests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "precompiled.hpp"

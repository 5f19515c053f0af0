#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "experiments/study/study.hpp"

namespace zerocount::python {

/// Adds to Study its random variables, and the outcomes of trials with given values of them.
void register_sampling(pybind11::class_<study::Study, std::shared_ptr<study::Study>>& object);

}  // namespace zerocount::python

#pragma once

/// For headers that only refer to a study.
namespace zerocount::study {

struct Study;      // see study.hpp
struct StudyPlan;  // see plan.hpp

}  // namespace zerocount::study

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/record/fit/solver.hpp"

namespace zerocount::fit {

SearchResult search_least_squares(ceres::Problem& problem, const SearchSetting& setting) {
  [[maybe_unused]] static const bool quiet = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;  // which end the process
    return true;
  }();
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.linear_solver_type = setting.many_blocks ? ceres::DENSE_SCHUR : ceres::DENSE_QR;
  options.max_num_iterations = setting.max_steps;
  options.max_num_consecutive_invalid_steps = setting.max_invalid_steps;
  options.function_tolerance = setting.tolerance;
  options.parameter_tolerance = setting.parameter_tolerance;
  options.initial_trust_region_radius = setting.trust_region;
  if (setting.end != nullptr) options.callbacks.push_back(setting.end);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {summary.IsSolutionUsable(), summary.termination_type == ceres::CONVERGENCE,
          2.0 * summary.final_cost};  // Ceres' cost is half the sum
}

}  // namespace zerocount::fit

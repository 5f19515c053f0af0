#pragma once

namespace ceres {
class IterationCallback;
class Problem;
}  // namespace ceres

namespace zerocount::record_fit {

/// How far and how carefully to search. The defaults are those of Ceres.
struct SearchSetting {
  int max_steps{50};
  int max_invalid_steps{5};  ///< in a row: the residuals are not finite there
  double tolerance{1e-6};    ///< relative decrease of the sum of squares by a step that ends the search
  double parameter_tolerance{1e-8};        ///< relative change of the parameters that ends it
  double trust_region{1e4};                ///< radius for the first step
  bool many_blocks{false};                 ///< eliminates parameter blocks that few residuals depend on
  ceres::IterationCallback* end{nullptr};  ///< called after each step; not owned
};

struct SearchResult {
  bool found{false};  ///< otherwise the residuals are not finite, and the parameters are as before
  bool converged{false};
  double squares{0.0};  ///< sum of the squared residuals
};

/// Moves the parameters of the problem to the least sum of squares: Levenberg and Marquardt, on one thread.
///
/// The program calls ceres::Solve() nowhere else. It prints nothing: what Ceres would write to standard error
/// through glog, such as "Residual and Jacobian evaluation failed", is in the result, and the caller says
/// what it means for the records.
SearchResult search_least_squares(ceres::Problem& problem, const SearchSetting& setting);

}  // namespace zerocount::record_fit

#include "analysis/record/fit/solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/record/fit/residuals.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::fit {
namespace {

/// Variance of a reading in a fit to all readings, counts²: that of the rounding to counts.
constexpr double count_variance = 1.0 / 12.0;

/// The fits with a finite sum of squares, sorted by it, at most `most`.
std::vector<FitResult> by_squares(std::vector<FitResult> fits, std::size_t most) {
  std::erase_if(fits, [](const FitResult& fit) { return !std::isfinite(fit.squares); });
  std::stable_sort(fits.begin(), fits.end(),
                   [](const FitResult& one, const FitResult& other) { return one.squares < other.squares; });
  if (fits.size() > most) fits.resize(most);
  return fits;
}

/// Ceres cost function of a fit: the residuals of all records and of the prior. Its parameter blocks are the
/// contact's coordinates and the records' encoder offsets.
class JointResiduals : public ceres::CostFunction {
 public:
  JointResiduals(Records records, const Observations& observations, const FitSetting& setting)
      : records_(records), observations_(observations), setting_(setting) {
    std::size_t residuals = setting.model.ranges.size();
    for (const std::vector<AngleObservation>& of_record : observations) residuals += of_record.size();
    set_num_residuals(static_cast<int>(residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(setting.model.ranges.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(records.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    using Rows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
    const Eigen::Index dimension = dimension_of(setting_.model);
    const Point axis = Eigen::Map<const Point>(parameters[0], dimension);
    if (!is_within_reach(records_, setting_.model, setting_.prior, axis)) return false;
    const auto block = [&](std::size_t number, Eigen::Index columns) {
      double* const rows = jacobians != nullptr ? jacobians[number] : nullptr;
      Rows map(rows, rows != nullptr ? num_residuals() : 0, columns);
      map.setZero();
      return map;
    };
    Rows by_axis = block(0, dimension);
    Rows by_offset = block(1, static_cast<Eigen::Index>(records_.size()));
    const std::vector<RecordMotion>& motions = motions_at(axis, by_axis.rows() > 0);
    Eigen::Index row = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      const RecordMotion& motion = motions[r];
      if (!motion.path.allFinite() || (by_axis.rows() > 0 && !motion.sensitivity.allFinite())) return false;
      for (const AngleObservation& observation : observations_[r]) {
        const double scale = 1.0 / std::sqrt(observation.variance);
        residuals[row] =
            scale * (mean_over(observation, motion.path).value() + parameters[1][r] - observation.position);
        if (by_axis.rows() > 0) by_axis.row(row) = scale * mean_over(observation, motion.sensitivity);
        if (by_offset.rows() > 0) by_offset(row, static_cast<Eigen::Index>(r)) = scale;
        ++row;
      }
    }
    for (Eigen::Index j = 0; j < dimension; ++j, ++row) {  // the prior
      const double scale = setting_.free[static_cast<std::size_t>(j)] ? 1.0 / setting_.prior_spread : 0.0;
      residuals[row] = scale * (axis[j] - setting_.prior[j]);
      if (by_axis.rows() > 0) by_axis(row, j) = scale;
    }
    return true;
  }

 private:
  /// The motions simulated at the last point, which are kept. A step of the search asks for the paths at its
  /// end and, if it is taken, for the derivatives there.
  struct LastMotions {
    Point axis;
    std::vector<RecordMotion> motions;
    bool has_slopes{false};
    std::int64_t samples_of_slopes{0};
  };

  /// The modelled motions at the point; simulates them unless they are known. Counts the samples of what is
  /// asked for, not of what is simulated ahead, so that the end of the search does not depend on the number
  /// of threads.
  /// @param with_slopes whether the derivatives are needed
  const std::vector<RecordMotion>& motions_at(const Point& axis, bool with_slopes) const {
    if (last_.motions.empty() || last_.axis != axis) {
      last_ = {axis, {}};
      simulate(with_slopes || has_idle_threads());
    } else if (with_slopes && !last_.has_slopes) {
      simulate(true);
    }
    setting_.model.simulated->fetch_add(samples_of_paths(records_, setting_.model, axis) +
                                        (with_slopes ? last_.samples_of_slopes : 0));
    return last_.motions;
  }

  void simulate(bool with_slopes) const {
    FitModel model = setting_.model;
    model.simulated = std::make_shared<std::atomic<std::int64_t>>(0);
    FreeCoordinates free = setting_.free;
    if (!with_slopes) std::fill(free.begin(), free.end() - 1, false);
    const bool knows_paths = !last_.motions.empty();
    last_.motions = modelled_motions(records_, model, last_.axis, free, std::move(last_.motions));
    last_.has_slopes = with_slopes;
    last_.samples_of_slopes =
        model.simulated->load() - (knows_paths ? 0 : samples_of_paths(records_, model, last_.axis));
  }

  /// Whether there are enough idle threads that the derivatives take no longer than the paths alone.
  bool has_idle_threads() const {
    const auto columns = std::ranges::count(setting_.free, true) + 1;
    return columns * std::ssize(records_) <= parallel::threads();
  }

  Records records_;
  const Observations& observations_;
  const FitSetting& setting_;
  mutable LastMotions last_;
};

/// Ceres callback that ends a fit once it has simulated more samples than its settings allow.
class EndOfEffort : public ceres::IterationCallback {
 public:
  explicit EndOfEffort(const FitSetting& setting) : setting_(setting) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    const auto simulated = static_cast<double>(setting_.model.simulated->load());
    return simulated > setting_.max_simulated ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const FitSetting& setting_;
};

void keep_fixed(ceres::Problem& problem, double* axis, const FreeCoordinates& free) {
  std::vector<int> fixed;
  for (std::size_t j = 0; j < free.size(); ++j) {
    if (!free[j]) fixed.push_back(static_cast<int>(j));
  }
  if (fixed.size() == free.size()) {
    problem.SetParameterBlockConstant(axis);
  } else if (!fixed.empty()) {
    problem.SetManifold(axis, new ceres::SubsetManifold(static_cast<int>(free.size()), fixed));
  }
}

}  // namespace

Observations all_readings(Records records) {
  Observations observations;
  for (const TestRecord& record : records) {
    std::vector<AngleObservation>& of_record = observations.emplace_back();
    for (std::size_t k = 0; k < sample_count(record); ++k) {
      if (is_excluded(record, k)) continue;
      of_record.push_back({k, k, record.reading[k] + middle_of_reading(record), count_variance});
    }
  }
  return observations;
}

Observations observations_along(Records records, const FittedModel& model, const std::vector<double>& noise) {
  Observations observations(records.size());
  for (std::size_t r = 0; r < records.size(); ++r) {
    observe(records[r], model.motions[r].path, readings_of(records[r]), noise[r], observations[r]);
  }
  return observations;
}

FitResult fit_jointly(Records records, const Observations& observations, const FitPoint& start,
                      const FitSetting& given) {
  // Its own counter, so that the end does not depend on fits that run beside this one.
  FitSetting setting = given;
  setting.model.simulated = std::make_shared<std::atomic<std::int64_t>>(0);
  EndOfEffort end(setting);
  FitPoint point = start;
  ceres::Problem problem;
  problem.AddResidualBlock(new JointResiduals(records, observations, setting), nullptr, point.axis.data(),
                           point.offset.data());
  keep_fixed(problem, point.axis.data(), setting.free);
  SearchSetting search;
  search.max_steps = setting.max_steps;
  search.max_invalid_steps = setting.max_steps;
  search.tolerance = setting.tolerance;
  search.parameter_tolerance = 1e-9;
  search.end = &end;
  const SearchResult found = search_least_squares(problem, search);
  given.model.simulated->fetch_add(setting.model.simulated->load());
  if (!found.found) return {start, std::numeric_limits<double>::infinity(), false};
  return {point, found.squares, found.converged};
}

FitResult fit_from(Records records, const Observations& observations, const FitPoint& start,
                   FitSetting setting) {
  setting.prior = start.axis;
  return fit_jointly(records, observations, start, setting);
}

std::vector<FitResult> follow_best(Records records, const Observations& observations,
                                   std::vector<FitResult> fits, FitSetting setting, SearchRounds rounds) {
  for (const SearchRound& round : rounds) {
    fits = by_squares(std::move(fits), round.points);
    setting.max_steps = round.steps;
    parallel::for_each_index(fits.size(), [&](std::size_t i) {
      fits[i] = fit_from(records, observations, fits[i].point, setting);
    });
  }
  const std::size_t all = fits.size();
  return by_squares(std::move(fits), all);
}

FitResult with_mean_offsets(Records records, const FitModel& model, const Point& point) {
  FitResult result{{point, Eigen::VectorXd(static_cast<Eigen::Index>(records.size()))}, 0.0};
  for (std::size_t r = 0; r < records.size(); ++r) {
    const TestRecord& record = records[r];
    result.point.offset[static_cast<Eigen::Index>(r)] = record.reading.front() + middle_of_reading(record);
  }
  result.squares = std::numeric_limits<double>::infinity();
  if (!is_sampled(records, model, point)) return result;
  double squares = 0.0;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd left = residuals_along(records[r], modelled_path(records[r], model, point));
    const auto used = static_cast<double>(used_samples(records[r]));
    const double mean = left.sum() / used;
    if (!std::isfinite(mean)) return result;
    result.point.offset[static_cast<Eigen::Index>(r)] = mean;
    squares += (left.squaredNorm() - used * mean * mean) / count_variance;
  }
  result.squares = squares;
  return result;
}

std::vector<FitResult> promising_fits(Records records, const Observations& observations,
                                      const std::vector<Point>& starts, const FitSetting& setting,
                                      SearchRounds rounds) {
  constexpr double hopeless = 4.0;
  std::vector<FitResult> fits(starts.size());
  parallel::for_each_index(
      starts.size(), [&](std::size_t i) { fits[i] = with_mean_offsets(records, setting.model, starts[i]); });
  fits = follow_best(records, observations, std::move(fits), setting, rounds);
  std::erase_if(fits, [least = fits.empty() ? 0.0 : fits.front().squares](const FitResult& fit) {
    return fit.squares > hopeless * least;
  });
  return fits;
}

FittedModel model_at(Records records, const FitPoint& point, const FitSetting& setting) {
  FittedModel model{point, modelled_motions(records, setting.model, point.axis, setting.free)};
  for (std::size_t r = 0; r < records.size(); ++r) {
    model.motions[r].path.array() += point.offset[static_cast<Eigen::Index>(r)];
  }
  return model;
}

void observe_again(Records records, Fit& fit) {
  fit.noise = noise_along(records, fit.model);
  fit.observations = observations_along(records, fit.model, fit.noise);
}

void observe_at(Records records, const FitPoint& at, Fit& fit) {
  fit.model = model_at(records, at, fit.setting);
  observe_again(records, fit);
}

bool is_finite(const RecordMotion& motion) {
  return motion.path.allFinite() && motion.sensitivity.allFinite();
}

NormalEquations normal_equations(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting) {
  NormalEquationsSum sum(observations.size(), setting);
  for (std::size_t r = 0; r < observations.size(); ++r)
    sum.add(r, observations[r], model.motions[r].path, model.motions[r].sensitivity);
  return sum.with_prior(model.point.axis);
}

Eigen::MatrixXd textbook_covariance(const FittedModel& model, const Observations& observations,
                                    const FitSetting& setting) {
  return numerics::inverse_of_positive_definite(normal_equations(model, observations, setting).matrix);
}

}  // namespace zerocount::fit

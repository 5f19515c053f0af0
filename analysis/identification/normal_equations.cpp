#include "analysis/identification/joint_fit.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::identification {

FittedModel model_at(std::span<const TestRecord> records, const FitPoint& point, const FitSetting& setting) {
  FittedModel model{point, {}};
  for (std::size_t r = 0; r < records.size(); ++r) {
    model.motions.push_back(
        motion_with_sensitivity(records[r], point.contact, setting.creep_torque, setting.free));
    model.motions.back().path.array() += point.offset[static_cast<Eigen::Index>(r)];
  }
  return model;
}

NormalEquations normal_equations(const FittedModel& model, const Observations& observations,
                                 const FitSetting& setting) {
  NormalEquationsSum sum(observations.size(), setting);
  for (std::size_t r = 0; r < observations.size(); ++r)
    sum.add(r, observations[r], model.motions[r].path, model.motions[r].sensitivity);
  return sum.with_prior(model.point.contact);
}

Eigen::MatrixXd textbook_covariance(const FittedModel& model, const Observations& observations,
                                    const FitSetting& setting) {
  return numerics::inverse_of_positive_definite(normal_equations(model, observations, setting).matrix);
}

NormalEquationsSum::NormalEquationsSum(std::size_t records, const FitSetting& setting) : setting_(setting) {
  const Eigen::Index size = contact_dimension + static_cast<Eigen::Index>(records);
  sum_.matrix.setZero(size, size);
  sum_.gradient.setZero(size);
}

void NormalEquationsSum::add(std::size_t record, const std::vector<AngleObservation>& observations,
                             const Eigen::VectorXd& path, const PathSensitivity& sensitivity) {
  Eigen::Matrix<double, coordinate_count + 1, 1> slope;
  Eigen::Matrix<double, coordinate_count + 1, coordinate_count + 1> matrix;
  Eigen::Matrix<double, coordinate_count + 1, 1> gradient;
  matrix.setZero();
  gradient.setZero();
  slope[contact_dimension] = 1.0;  // of the offset
  for (const AngleObservation& observation : observations) {
    slope.head<contact_dimension>() = mean_over(observation, sensitivity);
    const double residual = observation.position - mean_over(observation, path).value();
    const double weight = 1.0 / observation.variance;
    matrix.noalias() += (weight * slope) * slope.transpose();
    gradient.noalias() += (weight * residual) * slope;
    sum_.squares += weight * residual * residual;
  }
  sum_.observations += observations.size();
  const Eigen::Index offset = contact_dimension + static_cast<Eigen::Index>(record);
  sum_.matrix.topLeftCorner(contact_dimension, contact_dimension) +=
      matrix.topLeftCorner<contact_dimension, contact_dimension>();
  sum_.matrix.block(0, offset, contact_dimension, 1) += matrix.topRightCorner<contact_dimension, 1>();
  sum_.matrix.block(offset, 0, 1, contact_dimension) += matrix.bottomLeftCorner<1, contact_dimension>();
  sum_.matrix(offset, offset) += matrix(contact_dimension, contact_dimension);
  sum_.gradient.head(contact_dimension) += gradient.head<contact_dimension>();
  sum_.gradient[offset] += gradient[contact_dimension];
}

NormalEquations NormalEquationsSum::with_prior(const ContactPoint& at) const {
  NormalEquations equations = sum_;
  const double weight = 1.0 / (setting_.prior_spread * setting_.prior_spread);
  for (Eigen::Index j = 0; j < contact_dimension; ++j) {
    if (setting_.free[static_cast<std::size_t>(j)]) {
      equations.matrix(j, j) += weight;
      equations.gradient[j] += weight * (setting_.prior[j] - at[j]);
    } else {
      equations.matrix.row(j).setZero();
      equations.matrix.col(j).setZero();
      equations.matrix(j, j) = 1.0;
      equations.gradient[j] = 0.0;
    }
  }
  return equations;
}

}  // namespace zerocount::identification

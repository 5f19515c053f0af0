#include "analysis/study_features.hpp"

#include <cstdint>

namespace zerocount {
namespace {

bool has_errors(const EncoderErrors& errors) {
  return errors.eccentricity != 0.0 || errors.interpolation != 0.0 || errors.noise != 0.0 ||
         errors.missed != 0.0;
}

}  // namespace

StudyFeatures trial_features(const TrialParameters& parameters) {
  StudyFeatures features;
  features.open_loop = !parameters.command.torque.levels.empty();
  features.travel = parameters.command.profile.shape != ReferenceShape::step;
  features.encoder_errors =
      has_errors(parameters.encoder.fine_errors) || has_errors(parameters.encoder.coarse_errors);
  features.final_error = features.travel || parameters.controller.ki == 0.0 ||
                         parameters.friction.model == FrictionModel::coulomb;
  return features;
}

StudyFeatures study_features(const Study& study) {
  StudyFeatures all;
  all.open_loop = study.open_loop;
  all.travel = study.trace_extras.reference;
  all.phases = study.trace_extras.phase;
  all.final_error = all.travel || all.phases;
  for (std::int64_t point = 0; point < point_count(study); ++point) {
    const StudyFeatures features = trial_features(study_trial(study, point, 0).parameters);
    all.travel = all.travel || features.travel;
    all.encoder_errors = all.encoder_errors || features.encoder_errors;
    all.final_error = all.final_error || features.final_error;
  }
  return all;
}

}  // namespace zerocount

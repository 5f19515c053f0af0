#include "analysis/study_features.hpp"

namespace zerocount {

StudyFeatures study_features(const Study& study) {
  StudyFeatures features;
  features.axis = study.units.axis;
  features.open_loop = study.open_loop;
  features.travel = study.trace_extras.reference;
  features.phases = study.trace_extras.phase;
  features.encoder_errors = study.loop_extras.encoder_errors;
  features.final_error = features.travel || features.phases || study.loop_extras.lasting_errors;
  features.stopping = study.outcome_extras.stopped;
  features.dependent_trials = study.design == Design::saltelli;
  return features;
}

}  // namespace zerocount

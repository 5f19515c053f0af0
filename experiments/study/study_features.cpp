#include "experiments/study/study_features.hpp"

#include <stdexcept>

namespace zerocount::study {
namespace {

bool is_spread(Design design) {
  switch (design) {
    case Design::latin_hypercube:
    case Design::sobol:
      return true;
    case Design::monte_carlo:
    case Design::saltelli:
      return false;
  }
  throw std::logic_error("a design that is none");
}

}  // namespace

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
  features.rigs = study.rigs > 0 && !study.open_loop;
  features.spread_trials = is_spread(study.design);
  return features;
}

}  // namespace zerocount::study

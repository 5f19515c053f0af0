#include "core/friction/friction_model.hpp"

namespace zerocount {

bool has_spring(FrictionModel model) {
  switch (model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return true;
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  return false;
}

bool has_creep(FrictionModel model) {
  switch (model) {
    case FrictionModel::presliding:
      return true;
    case FrictionModel::spring:
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  return false;
}

bool has_breakaway(FrictionModel model) {
  switch (model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
    case FrictionModel::coulomb:
      return true;
    case FrictionModel::none:
      break;
  }
  return false;
}

}  // namespace zerocount

#include "core/friction/friction_model.hpp"

#include "core/friction/laws.hpp"

namespace zerocount::friction {
namespace {

static_assert(FrictionLaws::traits.size() == static_cast<std::size_t>(FrictionModel::gms) + 1);
template <class Law>
constexpr bool is_law_of(FrictionModel model) {
  return FrictionLaws::traits[static_cast<std::size_t>(model)].word == Law::word;
}
static_assert(is_law_of<PreslidingFriction>(FrictionModel::presliding) &&
              is_law_of<SpringFriction>(FrictionModel::spring) &&
              is_law_of<CoulombFriction>(FrictionModel::coulomb) &&
              is_law_of<NoFriction>(FrictionModel::none) && is_law_of<DahlFriction>(FrictionModel::dahl) &&
              is_law_of<LuGreFriction>(FrictionModel::lugre) && is_law_of<GmsFriction>(FrictionModel::gms));

}  // namespace

const LawTraits& traits_of(FrictionModel model) {
  return FrictionLaws::traits.at(static_cast<std::size_t>(model));
}

std::span<const LawTraits> all_traits() {
  return FrictionLaws::traits;
}

std::vector<std::string_view> friction_model_labels() {
  std::vector<std::string_view> words;
  words.reserve(FrictionLaws::traits.size());
  for (const LawTraits& law : FrictionLaws::traits) words.push_back(law.word);
  return words;
}

bool has_friction(FrictionModel model) {
  return !traits_of(model).contact_parameters.empty();
}

double holding_limit(FrictionModel model, double breakaway, double coulomb_ratio) {
  if (!has_friction(model)) return 0.0;
  return model == FrictionModel::dahl ? breakaway * coulomb_ratio : breakaway;
}

bool has_spring(FrictionModel model) {
  return uses(traits_of(model), &FrictionParameters::k1);
}

bool has_creep(FrictionModel model) {
  return uses(traits_of(model), &FrictionParameters::alpha);
}

}  // namespace zerocount::friction

#include "core/friction/friction_model.hpp"

#include "core/friction/laws.hpp"

namespace zerocount::friction {
namespace {

static_assert(FrictionLaws::traits.size() == static_cast<std::size_t>(FrictionModel::none) + 1);
static_assert(FrictionLaws::traits[static_cast<std::size_t>(FrictionModel::coulomb)].word ==
              CoulombFriction::word);

}  // namespace

const LawTraits& traits_of(FrictionModel model) {
  return FrictionLaws::traits.at(static_cast<std::size_t>(model));
}

std::vector<std::string_view> friction_model_words() {
  std::vector<std::string_view> words;
  words.reserve(FrictionLaws::traits.size());
  for (const LawTraits& law : FrictionLaws::traits) words.push_back(law.word);
  return words;
}

bool has_spring(FrictionModel model) {
  return uses(traits_of(model), &FrictionParameters::k1);
}

bool has_creep(FrictionModel model) {
  return uses(traits_of(model), &FrictionParameters::alpha);
}

bool has_breakaway(FrictionModel model) {
  return uses(traits_of(model), &FrictionParameters::breakaway);
}

}  // namespace zerocount::friction

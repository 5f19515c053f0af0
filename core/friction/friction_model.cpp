#include "core/friction/friction_model.hpp"

#include <algorithm>

#include "core/friction/laws.hpp"

namespace zerocount {
namespace {

static_assert(FrictionLaws::traits.size() == static_cast<std::size_t>(FrictionModel::none) + 1);
static_assert(FrictionLaws::traits[static_cast<std::size_t>(FrictionModel::coulomb)].word ==
              CoulombFriction::word);

bool uses(FrictionModel model, ContactField field) {
  const auto& fields = traits_of(model).contact_parameters;
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

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
  return uses(model, &FrictionParameters::k1);
}

bool has_creep(FrictionModel model) {
  return uses(model, &FrictionParameters::alpha);
}

bool has_breakaway(FrictionModel model) {
  return uses(model, &FrictionParameters::breakaway);
}

}  // namespace zerocount

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::sections {
namespace {

struct Pair {
  std::uint32_t first{0};  // slots
  std::uint32_t second{0};
  double coefficient{0.0};
};

bool draws(const study::Value& value) {
  return value.kind == study::Value::Kind::distribution;
}

// Why the slot's value at some point cannot be part of a copula; empty if it can.
std::string fault_of(const study::Value& value) {
  switch (value.kind) {
    case study::Value::Kind::number:
      return "";
    case study::Value::Kind::derived:
      return "it follows from measured values, which can be correlated in its place";
    case study::Value::Kind::profile:
      return "it is a profile at some design point";
    case study::Value::Kind::distribution:
      break;
  }
  switch (value.level) {
    case study::DrawLevel::world:
    case study::DrawLevel::machine:
    case study::DrawLevel::trial:
      return "";
    case study::DrawLevel::study:
      return "it is drawn once for the study";
    case study::DrawLevel::contact:
      break;
  }
  return "it is drawn anew at each contact";
}

std::vector<std::string> drawn_names(const study::StudyPlan& plan) {
  std::vector<std::string> names;
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    const std::vector<const study::Value*> values = study::values_of(plan, slot);
    if (std::any_of(values.begin(), values.end(), [](const study::Value* value) { return draws(*value); }))
      names.emplace_back(plan.table.rows[slot].name);
  }
  return names;
}

// Whether a value of the slot could not be read, which is reported already.
bool is_unreadable(const study::StudyPlan& plan, std::size_t slot) {
  const std::vector<const study::Value*> values = study::values_of(plan, slot);
  return std::any_of(values.begin(), values.end(), [](const study::Value* value) {
    return value->kind == study::Value::Kind::number && std::isnan(value->number);
  });
}

// The slot of a parameter that is drawn at some design point, and that a copula can have.
std::optional<std::uint32_t> read_drawn(const yaml::Field& field, keys::StudyDraft& draft) {
  const std::string& name = field.node->text;
  const std::vector<std::string> known = drawn_names(draft.plan);
  const auto slots = study::find_slots(name, draft.plan.table);
  if (slots && slots->count == 1 && is_unreadable(draft.plan, slots->first)) return std::nullopt;
  if (std::find(known.begin(), known.end(), name) == known.end() || !slots || slots->count != 1) {
    const std::string nearest =
        known.empty() ? "" : fmt::format(", nearest known: {}", yaml::nearest_name(name, known));
    draft.problems.add(
        field, fmt::format("{} is not a drawn parameter{}", yaml::in_quotes(name), nearest),
        known.empty() ? "parameters with distributions" : fmt::format("one of {}", fmt::join(known, ", ")));
    return std::nullopt;
  }
  const std::vector<std::uint32_t>& sampled = draft.plan.sampled_slots;
  if (std::find(sampled.begin(), sampled.end(), slots->first) != sampled.end()) {
    draft.problems.add(field, fmt::format("{} cannot be correlated: its value comes from samples", name),
                       "a distribution of its own");
    return std::nullopt;
  }
  for (const study::Value* value : study::values_of(draft.plan, slots->first)) {
    const std::string fault = fault_of(*value);
    if (fault.empty()) continue;
    draft.problems.add(field, fmt::format("{} cannot be correlated: {}", name, fault),
                       "a distribution drawn for each world, machine or trial");
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(slots->first);
}

std::optional<Pair> read_pair(const yaml::Field& entry, keys::StudyDraft& draft) {
  const auto first = read_drawn(yaml::item_of(entry, 0), draft);
  const auto second = read_drawn(yaml::item_of(entry, 1), draft);
  if (!first || !second) return std::nullopt;
  if (*first == *second) {
    draft.problems.add(entry, "a parameter cannot be correlated with itself", "two different parameters");
    return std::nullopt;
  }
  return Pair{*first, *second, shapes::number_of(yaml::item_of(entry, 2))};
}

// How often the values of the slots are drawn, if equally often for all of them at all points.
std::optional<study::DrawLevel> common_level(const std::vector<std::uint32_t>& slots,
                                             const study::StudyPlan& plan) {
  std::set<study::DrawLevel> found;
  for (const std::uint32_t slot : slots) {
    for (const study::Value* value : study::values_of(plan, slot)) {
      if (draws(*value)) found.insert(value->level);
    }
  }
  return found.size() == 1 ? std::optional(*found.begin()) : std::nullopt;
}

// The slots of the pairs, in the order of columns.
std::vector<std::uint32_t> slots_of(const std::vector<Pair>& pairs, const study::StudyPlan& plan) {
  std::vector<std::uint32_t> slots;
  for (const std::size_t slot : study::slots_in_table_order(plan.table)) {
    if (std::any_of(pairs.begin(), pairs.end(),
                    [&](const Pair& pair) { return pair.first == slot || pair.second == slot; }))
      slots.push_back(static_cast<std::uint32_t>(slot));
  }
  return slots;
}

study::SquareMatrix matrix_of(const std::vector<Pair>& pairs, const std::vector<std::uint32_t>& slots) {
  const auto place = [&](std::uint32_t slot) {
    return static_cast<std::size_t>(std::find(slots.begin(), slots.end(), slot) - slots.begin());
  };
  study::SquareMatrix matrix(slots.size(), std::vector<double>(slots.size(), 0.0));
  for (std::size_t i = 0; i < slots.size(); ++i) matrix[i][i] = 1.0;
  for (const Pair& pair : pairs) {
    matrix[place(pair.first)][place(pair.second)] = pair.coefficient;
    matrix[place(pair.second)][place(pair.first)] = pair.coefficient;
  }
  return matrix;
}

void make_copula(const yaml::Field& list, const std::vector<Pair>& pairs, keys::StudyDraft& draft) {
  study::GaussianCopula copula;
  copula.slots = slots_of(pairs, draft.plan);
  const auto level = common_level(copula.slots, draft.plan);
  if (!level) {
    draft.problems.add(list, "these parameters are not drawn equally often: for each world, machine or trial",
                       fmt::format("the same `{}` for all of them", keys::per_key));
    return;
  }
  copula.level = *level;
  auto factor = study::cholesky_factor(matrix_of(pairs, copula.slots));
  if (!factor) {
    draft.problems.add(list,
                       "the correlation matrix, with 0 for the pairs not given, is not positive definite",
                       "smaller coefficients, or coefficients of the other pairs too");
    return;
  }
  copula.factor = std::move(*factor);
  draft.plan.copula = std::move(copula);
}

}  // namespace

void read_correlations(const yaml::Field& root, keys::StudyDraft& draft) {
  const auto list = yaml::find_field(root, "correlation");
  if (!list) return;
  const shapes::Shape& shape = keys::shape_of("correlation");
  if (!yaml::check_list(*list, shape.expected, draft.problems) || list->node->items.empty()) return;
  std::vector<Pair> pairs;
  std::set<std::set<std::uint32_t>> seen;
  bool complete = true;
  for (const yaml::Field& entry : shapes::items_of(*list)) {
    const auto pair =
        shapes::read(entry, shape.parts.front(), draft.problems) ? read_pair(entry, draft) : std::nullopt;
    complete = complete && pair;
    if (!pair) continue;
    if (!seen.insert({pair->first, pair->second}).second) {
      draft.problems.add(entry, "duplicate pair", "each pair once");
      complete = false;
      continue;
    }
    pairs.push_back(*pair);
    draft.study.correlations.push_back({std::string(draft.plan.table.rows[pair->first].name),
                                        std::string(draft.plan.table.rows[pair->second].name),
                                        pair->coefficient});
  }
  if (complete) make_copula(*list, pairs, draft);
}

}  // namespace zerocount::sections

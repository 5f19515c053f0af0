#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/loop/encoder.hpp"
#include "experiments/manifest/manifest.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/rules/value_rules.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::manifest {
namespace {

/// A motion that a trial commands: a move to a target, a sine reference or a recorded reference.
struct Motion {
  std::size_t slot{0};  ///< slot (index in the plan) of the value that commands the motion
  /// Slot of the previous target, from which the motion starts; equal to `slot` if there is none.
  std::size_t previous{0};
  bool judged_in_counts{true};  ///< the motion is judged by a band in counts, or by success
  std::string unseen{};         ///< reason why the encoder does not notice the motion; empty if it does
};

/// The motions that the trials of a study command, and whether the encoder notices them.
class Motions {
 public:
  Motions(const study::Study& study, const study::StudyPlan& plan)
      : study_(study),
        plan_(plan),
        unit_(parameters::unit_on(plan.units.axis, "rad")),
        encoder_(slot_of(rules::fine_encoder(plan))),
        overrun_(slot_of(parameter::command::sequence::overrun)),
        shape_(slot_of(parameter::command::profile::shape)),
        amplitude_(slot_of(parameter::command::profile::amplitude)) {}

  /// The slots (indices in the plan) of the values on which the motions depend.
  std::vector<std::size_t> slots() const {
    std::vector<std::size_t> slots = study::slots_of(plan_.list);
    slots.insert(slots.end(), {encoder_, overrun_, shape_, amplitude_});
    for (const std::string_view name : study::two_encoders) slots.push_back(slot_of(name));
    return slots;
  }

  /// The motions of the trial with this draw. Each trial at a design point in a setting has the same number
  /// of motions in the same order.
  std::vector<Motion> of(std::size_t point, std::int64_t draw) const {
    const study::StudyTrial trial =
        study::commanded_trial(study_, study::design_point(plan_, point),
                               study::trial_indices(study_).trial_of(draw, study::setting_at(plan_, point)));
    const double count = loop::fine_resolution(trial.parameters.encoder);
    std::vector<Motion> motions;
    for (std::size_t move = 0; move < trial.target_positions.size(); ++move)
      motions.push_back(to_target(trial, move, count));
    const loop::ReferenceProfile& profile = trial.parameters.command.profile;
    if (profile.shape == loop::ReferenceShape::sine) motions.push_back(sine(profile.amplitude, count));
    if (profile.shape == loop::ReferenceShape::record) motions.push_back(record(*profile.record, count));
    return motions;
  }

  /// The slots (indices in the plan) of the values that decide whether the encoder notices the motion.
  std::array<std::size_t, 3> involved(const Motion& motion) const {
    return {motion.slot, encoder_, motion.previous};
  }

 private:
  std::size_t slot_of(std::string_view name) const {
    return study::find_slots(name, plan_.table).value().first;
  }
  std::size_t slot_of_move(std::size_t move) const {
    if (!plan_.sequence) return plan_.list.first + move;
    const std::int64_t target = study_.sequence[move].target;
    return target < 0 ? overrun_ : plan_.list.first + static_cast<std::size_t>(target);
  }

  /// Whether the move is judged in counts: by success or by an error band. A tolerance judges the position
  /// itself.
  bool is_judged_in_counts(std::size_t move) const {
    const auto number = static_cast<std::int64_t>(move);
    return study_.goals.empty() || std::ranges::any_of(study_.goals, [number](const study::Goal& goal) {
             return !goal.tolerance && (goal.on.empty() || std::ranges::binary_search(goal.on, number));
           });
  }

  Motion to_target(const study::StudyTrial& trial, std::size_t move, double count) const {
    const std::vector<std::int64_t>& counts = trial.parameters.command.targets;
    const bool is_first = move == 0;
    const double to = trial.target_positions[move];
    const double from = is_first ? 0.0 : trial.target_positions[move - 1];
    Motion motion{slot_of_move(move), slot_of_move(is_first ? 0 : move - 1), is_judged_in_counts(move)};
    if (to != from && counts[move] == (is_first ? 0 : counts[move - 1]))
      motion.unseen = fmt::format(
          "the target {:.6g} {} and the position before it, {:.6g} {}, are the same count of {:.6g} {}", to,
          unit_, from, unit_, count, unit_);
    return motion;
  }

  Motion sine(double amplitude, double count) const {
    Motion motion{amplitude_, amplitude_, is_judged_in_counts(0)};
    if (std::llround(amplitude / count) == 0)
      motion.unseen = fmt::format("a sine of {:.6g} {} is less than half a count of {:.6g} {}", amplitude,
                                  unit_, count, unit_);
    return motion;
  }

  Motion record(const loop::ReferenceRecord& record, double count) const {
    const auto [lowest, highest] = std::ranges::minmax(record.position);
    Motion motion{shape_, shape_, is_judged_in_counts(0)};
    if (std::rint(lowest / count) == std::rint(highest / count))
      motion.unseen = fmt::format("a record from {:.6g} to {:.6g} {} stays at one count of {:.6g} {}", lowest,
                                  highest, unit_, count, unit_);
    return motion;
  }

  const study::Study& study_;
  const study::StudyPlan& plan_;
  std::string unit_;
  std::size_t encoder_, overrun_, shape_, amplitude_;
};

/// A motion that is too small for the encoder to notice, in some trials of a design point.
struct UnseenMotion {
  Motion motion;  ///< the motion in the first trial in which the encoder does not notice it
  std::int64_t trials{0};
};

/// The motions that the encoder does not notice in some of the first `trials` trials of a design point in a
/// setting.
std::vector<UnseenMotion> unseen_motions(const Motions& motions, std::size_t point, std::int64_t trials) {
  std::vector<UnseenMotion> unseen;
  for (std::int64_t i = 0; i < trials; ++i) {
    std::vector<Motion> found = motions.of(point, i);
    unseen.resize(found.size());
    for (std::size_t m = 0; m < found.size(); ++m) {
      if (!found[m].unseen.empty() && unseen[m].trials++ == 0) unseen[m].motion = std::move(found[m]);
    }
  }
  return unseen;
}

/// The number of design points that differ in the values of these slots; points with equal values are counted
/// once.
std::int64_t different_points(const study::StudyPlan& plan, std::span<const std::size_t> slots) {
  std::int64_t points = 0;
  study::visit_points(plan, slots, [&points](std::size_t) { return ++points > 0; });
  return points;
}

/// Number of trials of each point that are checked. It is limited so that all points together take seconds at
/// most.
std::int64_t trials_to_try(std::int64_t points) {
  constexpr std::int64_t max_in_all = 200'000;
  constexpr std::int64_t max_of_point = 10'000;
  return std::clamp<std::int64_t>(max_in_all / points, 1, max_of_point);
}

/// Text that names the design point, its setting (condition at an age) and the number of other points that
/// have the same values of motions and encoders; empty if all points have the same values.
/// @param different number of different combinations of these values
std::string point_text(const study::Study& study, std::size_t point, std::int64_t different) {
  if (different == 1) return "";
  const std::int64_t of_study = study::design_point(*study.plan, point);
  const std::int64_t all = study::point_count(study) * study.settings.total();
  const std::int64_t others = all / different - 1;
  return fmt::format(" at point {} ({}){}{}", of_study,
                     study.points.labels[static_cast<std::size_t>(of_study)],
                     study::setting_phrase(study.settings, study::setting_at(*study.plan, point)),
                     others > 0 ? fmt::format(" and {} others", others) : "");
}

bool is_drawn(const study::StudyPlan& plan, std::span<const std::size_t> slots, std::size_t point) {
  return std::ranges::any_of(slots, [&](std::size_t slot) {
    return study::value_at_point(plan, slot, point)->kind != study::Value::Kind::number;
  });
}

}  // namespace

void check_unseen_motions(const study::Study& study, const keys::PlanPlaces& places,
                          keys::StudyDraft& draft) {
  constexpr std::size_t max_reported = 20;
  const study::StudyPlan& plan = draft.plan;
  if (plan.open_loop) return;
  const Motions motions(study, plan);
  const std::vector<std::size_t> slots = motions.slots();
  const std::int64_t different = different_points(plan, slots);
  const std::int64_t max_trials = std::min(trials_to_try(different), study::draw_count(study));
  std::size_t reported = 0;
  study::visit_points(plan, slots, [&](std::size_t point) {
    const std::int64_t trials = is_drawn(plan, slots, point) ? max_trials : 1;
    for (const auto& [motion, count] : unseen_motions(motions, point, trials)) {
      if (count == 0 || ++reported > max_reported) continue;
      const std::string proportion =
          count == trials ? ""
                          : fmt::format(" in {:.3g} % of the trials",
                                        1e2 * static_cast<double>(count) / static_cast<double>(trials));
      const std::string what = fmt::format("{}{}{}: the encoder does not see this motion", motion.unseen,
                                           proportion, point_text(study, point, different));
      const bool of_record = plan.common.command.profile.record != nullptr;
      const yaml::Place place =
          of_record ? places.record : place_of_fault(places, plan, motions.involved(motion), point).place;
      const std::string_view path = of_record ? rules::record_key(plan) : plan.table.rows[motion.slot].name;
      constexpr const char* expected = "motions of a count or more, or a finer encoder";
      if (count == trials && motion.judged_in_counts && !draft.recorded) {
        draft.problems.add(place, path, what, expected);
      } else {
        draft.warnings.push_back(yaml::at_place(place, path, fmt::format("{}; expected {}", what, expected)));
      }
    }
    return reported < max_reported;
  });
}

}  // namespace zerocount::manifest

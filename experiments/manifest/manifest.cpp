#include "experiments/manifest/manifest.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/designs/designs.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/parameters/unknown_key.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/effects.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {
namespace {

// State of the reading of a manifest.
struct Manifest {
  yaml::Field root;
  keys::StudyDraft draft;
  keys::PlanPlaces places{};
  std::vector<sections::SweptAxis> axes{};
  sections::SweptAxis conditions{};

  yaml::Problems& problems() { return draft.problems; }
  study::StudyPlan& plan() { return draft.plan; }
  study::Study& study() { return draft.study; }
};

void check_version(Manifest& m) {
  const auto field = yaml::find_field(m.root, "zerocount");
  if (!field) return;
  const auto version = yaml::read_whole(*field, std::numeric_limits<std::int64_t>::min(),
                                        std::numeric_limits<std::int64_t>::max(), m.problems());
  if (!version || *version == keys::manifest_version) return;
  const bool newer = *version > keys::manifest_version;
  m.problems().add(*field,
                   newer ? fmt::format("manifest version {} is newer than this program", *version)
                         : fmt::format("unknown manifest version {}", *version),
                   fmt::format("version {}{}", keys::manifest_version, newer ? ", or a newer program" : ""));
}

// Reads the keys with one value that do not depend on others.
void read_values(Manifest& m) {
  check_version(m);
  for (const shapes::Shape& key : keys::general_keys()) {
    const bool is_of_section = key.name.find('.') != std::string_view::npos;
    if (!is_of_section && (key.set || !yaml::find_field(m.root, key.name)))
      shapes::read_keys(m.root, {&key, 1}, m.problems(), &m.draft);
  }
  m.draft.groups = {.machines = yaml::find_field(m.root, "machines").has_value(),
                    .worlds = yaml::find_field(m.root, "worlds").has_value(),
                    .ages = yaml::find_field(m.root, "ages").has_value()};
}

// Reads `travel`, `controller.units` and `command.units`. Must come first, because all other values depend on
// the units.
void read_study_units(const yaml::Field& root, keys::StudyDraft& draft) {
  study::StudyPlan& plan = draft.plan;
  const bool linear = plan.units.axis == parameters::AxisKind::linear;
  if (linear) plan.period.reset();
  if (const auto travel = yaml::find_field(root, "travel")) {
    const bool sound = shapes::read(*travel, keys::shape_of("travel"), draft.problems);
    if (linear && sound) plan.period = shapes::number_of(*travel);
  }
  for (const std::string_view section : {"controller", "command"}) {
    const auto map = yaml::find_field(root, section);
    const auto units = map ? yaml::find_field(*map, "units") : std::nullopt;
    if (units) shapes::read(*units, keys::shape_of(units->path), draft.problems, &draft);
  }
  if (plan.units.targets == parameters::TargetUnits::si) study::use_si_positions(plan.table);
}

// Warns if `travel` is given and nothing varies along it.
void check_travel(const yaml::Field& root, keys::StudyDraft& draft) {
  const auto travel = yaml::find_field(root, "travel");
  if (!travel || !draft.profiles.empty() || draft.plan.units.axis == parameters::AxisKind::rotary) return;
  draft.warnings.push_back(yaml::at_place(travel->node->place, travel->path,
                                          "it has no effect: no friction parameter is a profile"));
}

void read_axes(Manifest& m) {
  if (const auto field = yaml::find_field(m.root, "sweep")) m.axes = sections::read_sweep(*field, m.draft);
  for (const sections::SweptAxis& axis : m.axes) {
    if (axis.labels.empty()) {  // could not be read, but gives these values
      for (const std::size_t slot : axis.slots) {
        m.plan().base[slot] = keys::unreadable_value();
        m.places.base[slot] = axis.place;
        m.places.written[slot] = true;
      }
      continue;
    }
    m.plan().axes.push_back(axis.axis);
    m.places.axes.push_back(axis.places);
  }
}

void read_conditions(Manifest& m) {
  const auto field = yaml::find_field(m.root, "conditions");
  if (field) m.conditions = sections::read_conditions(*field, m.axes, m.draft);
  const sections::SweptAxis settings = sections::settings_axis(m.conditions, m.draft);
  if (!settings.labels.empty()) {
    m.plan().axes.push_back(settings.axis);
    m.plan().settings_axis = m.plan().axes.size() - 1;
    m.plan().settings = m.study().settings.counts();
    m.places.axes.push_back(settings.places);
  }
  for (study::PlanAxis& axis : m.plan().axes) sections::inherit_aging(axis, m.plan());
  m.places.base.resize(m.plan().base.size(), m.root.node->place);  // for rates that only axes have
  m.places.written.resize(m.plan().base.size(), false);
}

void check_trial_count(Manifest& m) {
  std::int64_t points = 1;
  for (const study::PlanAxis& axis : m.plan().axes)
    points *= static_cast<std::int64_t>(study::option_count(axis));
  points /= m.plan().settings.total();
  const auto field = yaml::find_field(m.root, "trials");
  if (field && m.study().trials > keys::max_study_trials / points) {
    m.problems().add(*field, fmt::format("{} trials at {} points are too many", m.study().trials, points),
                     fmt::format("at most {} trials in all", keys::max_study_trials));
  }
}

std::string nearest_multiples(std::int64_t number, std::int64_t of) {
  const std::int64_t below = number / of * of;
  return below == 0 ? std::to_string(of) : fmt::format("{} or {}", below, below + of);
}

// The design saltelli needs whole rows; a row has as many trials as there are factors, plus two.
void check_rows(Manifest& m) {
  const auto field = yaml::find_field(m.root, "trials");
  if (m.study().design != study::Design::saltelli || !field || m.study().trials == 0) return;
  const std::vector<std::string> names = randomness::factor_names(m.plan());
  if (names.empty()) {
    const yaml::Field design = yaml::find_field(m.root, "design").value();
    m.problems().add(design, "nothing is drawn in this study", "a distribution for at least one parameter");
    return;
  }
  const auto row = static_cast<std::int64_t>(designs::saltelli_row_length(names.size()));
  if (m.study().trials % row == 0) return;
  m.problems().add(
      *field,
      fmt::format(
          "{} trials are not a multiple of {}, the row length of the design saltelli for {} factor{} ({})",
          m.study().trials, row, names.size(), names.size() == 1 ? "" : "s", fmt::join(names, ", ")),
      fmt::format("a multiple of {}, such as {}", row, nearest_multiples(m.study().trials, row)));
}

// "7 machines", "7 machines under each of 3 conditions at each of 2 ages".
std::string groups_text(const study::Study& study) {
  const auto counted = [](std::int64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
  };
  const std::int64_t conditions = std::ssize(study.settings.conditions);
  if (study.machines == 0) return counted(conditions, "condition");
  std::string text = fmt::format("{} machines", study.machines);
  if (conditions > 0) text += " under each of " + counted(conditions, "condition");
  if (!study.settings.ages.at.empty())
    text += " at each of " + counted(std::ssize(study.settings.ages.at), "age");
  return text;
}

void require_equal_groups(Manifest& m, const yaml::Field& field, std::int64_t trials) {
  const study::TrialIndices indices = study::trial_indices(m.study());
  const std::int64_t round = indices.machines * indices.settings.total();
  if (trials % round == 0) return;
  m.problems().add(
      field, fmt::format("{} trials cannot be divided equally among {}", trials, groups_text(m.study())),
      fmt::format("a multiple of {}, such as {}", round, nearest_multiples(trials, round)));
}

// Every machine must have the same number of trials under each condition, also after each block of sequential
// stopping.
void check_equal_groups(Manifest& m) {
  const auto trials = yaml::find_field(m.root, "trials");
  const std::int64_t block = m.study().stop ? m.study().stop->block : m.study().trials;
  if (trials && block > 0) require_equal_groups(m, *trials, block);
  if (m.study().stop) {
    const auto limit = yaml::find_field(yaml::find_field(m.root, "stop").value(), "max_trials");
    if (limit) require_equal_groups(m, *limit, m.study().stop->max_trials);
  }
}

// Every world must have the same number of machines, or of trials.
void check_worlds(Manifest& m) {
  if (m.study().worlds == 0) return;
  const yaml::Field field = yaml::find_field(m.root, "worlds").value();
  const std::int64_t units = m.study().machines > 0 ? m.study().machines : study::draw_count(m.study());
  const std::string_view name = m.study().machines > 0       ? "machines"
                                : m.study().settings.empty() ? "trials"
                                                             : "trials under each condition";
  if (m.study().machines > 0 && units % m.study().worlds != 0) {
    m.problems().add(
        field, fmt::format("{} machines cannot be divided equally among {} worlds", units, m.study().worlds),
        fmt::format("a divisor of the number of machines, or {} machines",
                    nearest_multiples(units, m.study().worlds)));
  } else if (units > 0 && units < m.study().worlds) {
    m.problems().add(field, fmt::format("the study has only {} {}", units, name),
                     fmt::format("at most {}", units));
  }
}

// Warns if the worlds do not differ.
void warn_of_equal_worlds(Manifest& m) {
  if (m.study().worlds == 0) return;
  for (const study::InputColumn& column : m.study().columns.inputs) {
    if (column.level == study::DrawLevel::world) return;
  }
  const yaml::Field field = yaml::find_field(m.root, "worlds").value();
  m.draft.warnings.push_back(yaml::at_place(field.node->place, field.path,
                                            "the worlds are all alike: no value is drawn `per: world`"));
}

// Warns if all ages are alike.
void warn_of_equal_ages(Manifest& m) {
  const auto field = yaml::find_field(m.root, "ages");
  if (field && m.plan().agings.empty())
    m.draft.warnings.push_back(yaml::at_place(field->node->place, field->path,
                                              "the ages are all alike: no value has `aging` beside it"));
}

void read_retained(Manifest& m) {
  const auto field = yaml::find_field(m.root, "retain");
  if (!field) return;
  shapes::Shape retain = keys::shape_of("retain");
  shapes::limit_items(retain, "trials", m.study().trials - 1);
  shapes::read(*field, retain, m.problems(), &m.draft);
  std::ranges::sort(m.study().retained_trials);
}

void read_observed(Manifest& m) {
  const auto field = yaml::find_field(m.root, "observed");
  const bool complete =
      std::none_of(m.axes.begin(), m.axes.end(), [](const auto& axis) { return axis.labels.empty(); });
  if (!field || !complete) return;  // an incomplete axis is reported already
  sections::read_observations(*field, m.axes, m.draft);
}

}  // namespace

study::Study read_manifest(const yaml::YamlNode& root, bool recorded,
                           const sections::ExternalInputs& external, const sections::SamplesTable* samples,
                           yaml::Problems& problems) {
  auto plan = std::make_shared<study::StudyPlan>();
  study::Study study;
  Manifest m{.root = {&root, ""}, .draft = {problems, *plan, study, recorded}};
  if (!yaml::check_map({&root, "manifest"}, "a map with the keys zerocount, name, seed, trials, command",
                       problems))
    return {};
  parameters::check_keys(m.root, keys::keys_below(""), problems);
  check_exclusions(m.root, problems);
  read_values(m);
  read_study_units(m.root, m.draft);
  sections::read_ages(m.root, m.draft);
  sections::read_plugin(m.root, external.plugin, m.draft);
  sections::read_sections(m.root, m.draft, m.places);
  read_axes(m);
  read_conditions(m);
  if (samples != nullptr) sections::join_samples(*samples, m.axes, m.draft);
  let_follow_from_measured(m.places, m.draft);
  sections::read_correlations(m.root, m.draft);
  read_retained(m);
  if (const auto field = yaml::find_field(m.root, "stop")) sections::read_stop(*field, m.draft);
  sections::read_goals(m.root, m.draft);
  sections::measure_both_masses(m.plan());
  if (const auto field = yaml::find_field(m.root, "tune")) sections::read_tuning(*field, m.draft);
  sections::check_overrides(m.root, m.conditions,
                            samples != nullptr ? samples->columns : std::vector<yaml::Place>{}, m.draft);
  check_trial_count(m);
  check_equal_groups(m);
  check_worlds(m);
  read_observed(m);
  realise_profiles(m.draft.profiles, study, external.rotors, *plan);
  keys::check_profiles(m.draft);
  check_what_follows(m.places, m.draft);
  check_points(m.places, m.draft);
  check_ages(m.places, m.draft);
  check_travel(m.root, m.draft);
  if (problems.empty()) check_rows(m);
  for (std::size_t slot = 0; slot < plan->table.rows.size(); ++slot)
    plan->given.push_back(given_place(m.places, *plan, slot).has_value());
  if (problems.empty()) assemble_study(m.draft.profiles, m.axes, *plan, study);
  if (problems.empty()) warn_of_equal_worlds(m);
  warn_of_equal_ages(m);
  study.plugin = plan->plugin;
  study.plan = plan;
  if (problems.empty()) check_measured_machines(study, m.places, m.draft);
  if (problems.empty()) check_unseen_motions(study, m.places, m.draft);
  study.features.coarse_errors = study.features.encoder_errors && study::has_coarse_encoder(*plan);
  study.premises = study::premises_of(*plan);
  study.warnings = std::move(m.draft.warnings);
  return study;
}

}  // namespace zerocount::manifest

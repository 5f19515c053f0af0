#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/fit/report.hpp"
#include "analysis/record/sliding_identification/sliding_identification.hpp"

namespace zerocount::sliding_identification {
namespace {

using fit::for_people;
using fit::is_estimated;
using fit::length_text;

std::size_t used_samples(const SlidingRecord& record) {
  std::size_t used = 0;
  for (const Window& window : record.windows) used += samples_of(window);
  return used;
}

document::Description<SlidingRecord> record_description() {
  using document::in_data;
  return document::Description<SlidingRecord>()
      .value({"name", "record", "file, and part of it"},
             [](const SlidingRecord& r) { return text::printable(r.name); })
      .value({"samples", "samples", "samples of the record"},
             [](const SlidingRecord& r) { return r.time.size(); })
      .value({"duration", "duration", "its duration", "s"},
             [](const SlidingRecord& r) { return r.time.back(); })
      .value(in_data("resolution", "step of the readings, rad or m"), &SlidingRecord::resolution)
      .value(for_people("resolution_text", "read in steps of"),
             [](const SlidingRecord& r) { return length_text(r.resolution, r.axis); })
      .value(
          in_data(
              "presliding_travel",
              "travel after a standstill or a reversal in which the friction is below its level of sliding, which was left out, rad or m"),
          &SlidingRecord::presliding_travel)
      .value(for_people("presliding_text", "left out after each reversal"),
             [](const SlidingRecord& r) { return length_text(r.presliding_travel, r.axis); })
      .value({"strokes", "strokes", "strokes of the record"},
             [](const SlidingRecord& r) { return r.strokes.size(); })
      .value({"windows", "windows", "windows of the fit"},
             [](const SlidingRecord& r) { return r.windows.size(); })
      .value({"used", "samples used", "samples in the windows"}, used_samples)
      .value(in_data("min_velocity", "least speed, rad/s or m/s"), &SlidingRecord::min_velocity)
      .value(in_data("max_velocity", "largest speed, rad/s or m/s"), &SlidingRecord::max_velocity)
      .value(for_people("velocities", "speeds"), [](const SlidingRecord& r) {
        return fmt::format("{:.3g} to {:.3g} {}/s", r.min_velocity, r.max_velocity,
                           parameters::unit_on(r.axis, "rad"));
      });
}

document::Description<FreeRun> run_description() {
  using document::in_data;
  return document::Description<FreeRun>()
      .value({"name", "record", "file, and part of it"},
             [](const FreeRun& r) { return text::printable(r.name); })
      .value({"start", "from", "time at which the simulation begins with the measured state", "s"},
             &FreeRun::start)
      .value({"duration", "duration", "simulated time without a restart", "s"}, &FreeRun::duration)
      .value(in_data("rms", "root mean square of simulated less read positions, rad or m"), &FreeRun::rms)
      .value(for_people("rms_text", "error rms"), [](const FreeRun& r) { return length_text(r.rms, r.axis); })
      .value(in_data("max", "largest difference, rad or m"), &FreeRun::max)
      .value(for_people("max_text", "largest"), [](const FreeRun& r) { return length_text(r.max, r.axis); })
      .value(in_data("stroke", "largest less smallest reading, rad or m"), &FreeRun::stroke)
      .value({.key = "proportion",
              .heading = "of the stroke",
              .meaning = "rms over the stroke",
              .unit = "1",
              .notation = document::Notation::percent},
             [](const FreeRun& r) { return r.rms / r.stroke; });
}

std::string reversal_sentence(const SlidingIdentification& i) {
  if (!i.reversal) return "";
  const ReversalFriction& r = *i.reversal;
  const std::string length = parameters::unit_on(i.axis, "rad");
  if (r.samples < min_reversal_samples)
    return fmt::format(
        "After a reversal the friction changes by {:.3g} {} within {:.3g} {}, {} samples or fewer: faster "
        "than this record shows. Its stiffness before sliding remains unknown.",
        r.swing, parameters::unit_on(i.axis, "N m"), r.max_travel, length, r.samples);
  return fmt::format(
      "After each of {} reversals nine tenths of the change of the friction, which is {:.3g} {} in all, take "
      "place within {:.3g} to {:.3g} {}, {} samples: a secant stiffness of {:.2g} {} before sliding. Its "
      "course in between is smoothed over 7 samples, and creep and the stiffness at rest remain unknown: "
      "material tests before sliding show them (zerocount experiment).",
      r.reversals.size(), r.swing, parameters::unit_on(i.axis, "N m"), r.min_travel, r.max_travel, length,
      r.samples, r.stiffness, parameters::unit_on(i.axis, "N m/rad"));
}

/// Sentences on the position-dependent torques of the fit, one each, and on whether the position explains
/// more of the unexplained torque.
std::string position_text(const SlidingIdentification& i) {
  const std::string torque = parameters::text_on(i.axis, "$torque");
  std::string text;
  for (const PositionWave& wave : i.waves) {
    const bool linear = i.axis == parameters::AxisKind::linear;
    const std::string name = name_of(wave) + (wave.periods == 0.0 ? "" : ".amplitude");
    const auto& size = *std::ranges::find(i.parameters, name, &fit::ParameterEstimate::name);
    const std::string value =
        is_estimated(size) ? fmt::format("A {} of {:.3g} {}", torque, size.value, size.unit) : "A " + torque;
    if (wave.periods == 0.0)
      text += fmt::format("{} times the position acts, as of a spring.\n", value);
    else if (wave.periods == 1.0)
      text += fmt::format("{} repeats {}{}.{}\n", value, linear ? "with the pitch" : "once in a revolution",
                          linear ? "" : ", as gravity does",
                          i.could_be_two_periods
                              ? " One that acts twice in it leaves at most 5 % more unexplained: "
                                "amplitude and phase hold if it acts once."
                              : "");
    else
      text += fmt::format("{} repeats {:g} times in a {}, as cogging does.\n", value, wave.periods,
                          linear ? "pitch" : "revolution");
  }
  const bool turns = i.axis == parameters::AxisKind::rotary;
  if (turns && std::ranges::find(i.waves, 1.0, &PositionWave::periods) == i.waves.end())
    text += "Gravity was tried: the records do not show it.\n";
  const std::string reason = reason_of_distrust(i);
  return text + (reason.empty() ? "" : "The result must not be trusted: " + reason + ".");
}

document::Description<ReversalFriction> reversal_description() {
  using document::in_data;
  return document::Description<ReversalFriction>()
      .value(in_data("reversals", "reversals without a standstill"),
             [](const ReversalFriction& r) { return r.reversals.size(); })
      .value(in_data("swing", "sum of the levels of both directions near a reversal, median, N m or N"),
             &ReversalFriction::swing)
      .value(
          in_data(
              "travel",
              "travel after a reversal in which nine tenths of the change of the friction take place, median, rad or m"),
          &ReversalFriction::travel)
      .value(in_data("min_travel", "smallest of them, rad or m"), &ReversalFriction::min_travel)
      .value(in_data("max_travel", "largest of them, rad or m"), &ReversalFriction::max_travel)
      .value(in_data("samples", "samples in that travel, median; below 6 the travel is an upper bound"),
             &ReversalFriction::samples)
      .value(in_data("stiffness", "0.9 times swing, divided by travel, N m/rad or N/m"),
             &ReversalFriction::stiffness);
}

document::Description<SecondMass> second_mass_description() {
  using document::in_data;
  return document::Description<SecondMass>()
      .value(in_data("explained", "part of the squares of the residuals that it explains", "1"),
             &SecondMass::explained)
      .value(in_data("frequency", "frequency of the masses against each other, Hz; 0: not well known"),
             &SecondMass::frequency);
}

document::Description<MissingTorque> missing_description() {
  return document::Description<MissingTorque>()
      .value(
          with_words(
              document::Item{.key = "cause", .heading = "goes with", .meaning = "what the torque goes with"},
              cause_words()),
          [](const MissingTorque& one) { return to_string(one.cause); })
      .value({"torque", "torque", "the torque, in words"}, &MissingTorque::name)
      .value({.key = "explained",
              .heading = "of the squares",
              .meaning = "proportion of the squares of the residuals that it explains",
              .unit = "1",
              .notation = document::Notation::percent},
             &MissingTorque::explained)
      .value(
          {"visibility", "over chance",
           "ratio of its coefficient to the standard error, over the ratio that chance exceeds once in 1000 records",
           "1"},
          &MissingTorque::visibility);
}

document::Description<RepeatingForce> force_description() {
  return document::Description<RepeatingForce>()
      .value({"with", "with", "what the unexplained torque may repeat with"}, &RepeatingForce::with)
      .value({"predicted", "predicted",
              "part of its variance that the means over other strokes predict; 0 or less: it does not repeat",
              "1"},
             &RepeatingForce::predicted)
      .value({"low", "least mean", "smallest mean over a tenth of the range, N m or N"}, &RepeatingForce::low)
      .value({"high", "largest mean", "largest mean over a tenth of the range, N m or N"},
             &RepeatingForce::high);
}

}  // namespace

document::AnswerDescription<SlidingIdentification> sliding_answer() {
  using document::in_data;
  document::AnswerDescription<SlidingIdentification> answer{
      {.name = "identify-sliding",
       .meaning = "inertia and friction of an axis from its sliding motion",
       .csv_table = "parameters"},
      {}};
  answer.items
      .headline([](const SlidingIdentification& i) {
        const std::string reason = reason_of_distrust(i);
        return fmt::format("{}{} of {} parameters of the sliding axis are estimated",
                           reason.empty() ? "" : "LACK OF FIT: " + reason + "; ",
                           std::ranges::count_if(i.parameters, is_estimated), i.parameters.size());
      })
      .value(in_data("kind", "always sliding"), [](const SlidingIdentification&) { return "sliding"; })
      .include(fit::estimates_description(),
               [](const SlidingIdentification& i) -> const fit::FitReport& { return i; })
      .object(in_data("correlation", "correlation of the errors of the fitted parameters"),
              document::Description<SlidingIdentification>()
                  .value(in_data("parameters", "names, in the order of the matrix"),
                         &SlidingIdentification::correlated)
                  .value(in_data("matrix", "correlations", "1"), &SlidingIdentification::correlation),
              std::identity())
      .table({"records", "Records", "what was used of each record"}, record_description(),
             &SlidingIdentification::records)
      .value(in_data("misfit", "root mean square of the residuals, in steps of the readings"),
             &SlidingIdentification::misfit)
      .value(in_data("unexplained_torque", "its root mean square over the windows, N m or N"),
             &SlidingIdentification::unexplained_torque)
      .value(in_data("torque", "root mean square of the torque in the strokes, N m or N"),
             &SlidingIdentification::torque)
      .sentence([](const SlidingIdentification& i) {
        return fmt::format(
            "Residual rms {:.3g} steps of the readings, and {:.3g} of {:.3g} {}. The intervals allow for "
            "residuals that depend on each other within a window or a stroke.",
            i.misfit, i.unexplained_torque, i.torque, parameters::unit_on(i.axis, "N m"));
      })
      .sentence(position_text)
      .object(
          in_data("second_mass",
                  "a second mass that the records show; null: none is shown, or another fault comes first"),
          second_mass_description(), &SlidingIdentification::second_mass)
      .table({"missing", "Torques that the law lacks", "torques that the residuals show; empty: none"},
             missing_description(), &SlidingIdentification::missing)
      .object(in_data("reversal", "friction after reversals; null: none without a standstill"),
              reversal_description(),
              [](const SlidingIdentification& i) { return i.reversal ? &*i.reversal : nullptr; })
      .sentence(reversal_sentence)
      .table({"simulation", "Simulated under the recorded torque, without a restart",
              "motion of the identified axis beside the readings"},
             run_description(), &SlidingIdentification::runs)
      .table({"unexplained", "What the unexplained torque repeats with",
              "cross-validated over strokes; empty with a single stroke"},
             force_description(), &SlidingIdentification::forces)
      .value(fit::fragment_item(), &SlidingIdentification::fragment);
  return answer;
}

}  // namespace zerocount::sliding_identification

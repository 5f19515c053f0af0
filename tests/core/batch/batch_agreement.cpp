#include "tests/core/batch/batch_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <fmt/core.h>

#include "tests/core/batch/reversal_depths.hpp"

namespace zerocount::testing {
namespace {

constexpr double accuracy = 1e-6;  // counts, before a slide

/// Comparison of one trial of the batch engine with the reference, with the disagreements found so far.
class Comparison {
 public:
  Comparison(const trial::TrialParameters& parameters, const BatchedTrial& batched, const std::string& name)
      : parameters_(parameters),
        batched_(batched),
        name_(name),
        resolution_(2.0 * std::numbers::pi / parameters.encoder.fine) {}

  void take(const trial::SampleRecord& sample);
  void take_outcome(const trial::TrialOutcome& outcome, const std::vector<trial::Jerk>& jerks);
  BatchAgreement result() const { return result_; }

 private:
  bool settled() const { return on_edge() || result_.other_counts > 0; }
  bool on_edge() const { return result_.on_edge > 0; }
  void fail(std::int64_t BatchAgreement::*what, const std::string& text);
  void compare_before_slide(const trial::SampleRecord& a, const batch::BatchSample& b, double difference);
  void compare_after_slide(const trial::SampleRecord& a, const batch::BatchSample& b, double difference);
  void compare_move(std::size_t number, const trial::MoveOutcome& a, const trial::MoveOutcome& b);
  void compare_jerks(std::int64_t moves, const std::vector<trial::Jerk>& jerks);
  double edge_distance(const trial::SampleRecord& sample) const;
  /// Allowed difference of the rotor angle θ at the last compared sample, counts.
  double allowed() const { return slid_ ? 1e-3 + 1e-7 * travel_ / resolution_ : accuracy; }

  const trial::TrialParameters& parameters_;
  const BatchedTrial& batched_;
  const std::string& name_;
  double resolution_;
  BatchAgreement result_;

  std::int64_t taken_{0};
  trial::SampleRecord last_;
  bool slid_{false};
  std::int64_t before_slide_{0};  // samples
  double travel_{0.0};            // rad
};

void Comparison::fail(std::int64_t BatchAgreement::*what, const std::string& text) {
  result_.*what = 1;
  result_.failures.push_back(fmt::format("{}: {}", name_, text));
}

double Comparison::edge_distance(const trial::SampleRecord& sample) const {
  const bool at_load = parameters_.plant.load.encoder == motion::EncoderPlace::load;
  const double position =
      (at_load ? sample.load_theta : sample.theta) / resolution_ + parameters_.initial.encoder_phase;
  return std::abs(position - std::round(position));
}

void Comparison::take(const trial::SampleRecord& sample) {
  const trial::SampleRecord before = last_;
  last_ = sample;
  const auto i = static_cast<std::size_t>(taken_++);
  if (i > 0) {
    travel_ += std::abs(sample.theta - before.theta);
    // A slide may begin and end between two samples; a contact that is new has lost its hardening.
    slid_ = slid_ || sample.xh < before.xh;
  }
  slid_ = slid_ || sample.mode == trial::HookMode::slide;
  if (!slid_) before_slide_ = taken_;
  if (settled() || result_.part > 0) return;
  if (i >= batched_.samples.size() || batched_.samples[i].k != sample.k) {
    fail(&BatchAgreement::other_counts, fmt::format("sample {} is missing", i));
    return;
  }
  const batch::BatchSample& other = batched_.samples[i];
  const double difference = std::abs(sample.theta - other.theta) / resolution_;
  slid_ ? compare_after_slide(sample, other, difference) : compare_before_slide(sample, other, difference);
}

void Comparison::compare_before_slide(const trial::SampleRecord& a, const batch::BatchSample& b,
                                      double difference) {
  if (a.count != b.count && std::abs(a.count - b.count) == 1 && difference < accuracy &&
      edge_distance(a) < accuracy) {
    result_.on_edge = 1;
    return;
  }
  if (a.count != b.count || a.code != b.code || !(difference < accuracy)) {
    fail(&BatchAgreement::other_counts,
         fmt::format("sample {}: count {} and {}, code {} and {}, theta {:.2g} count apart", a.k, a.count,
                     b.count, a.code, b.code, difference));
    return;
  }
  result_.samples += 1;
  result_.theta = std::max(result_.theta, difference);
  result_.floating = std::max(result_.floating, std::abs(a.xp - b.xp) / resolution_);
}

void Comparison::compare_after_slide(const trial::SampleRecord& a, const batch::BatchSample& b,
                                     double difference) {
  const bool differ = a.count != b.count || a.code != b.code;
  const bool on_an_edge = difference < allowed() && edge_distance(a) < allowed();
  if (result_.stray == 0 && (!(difference < allowed()) || (differ && !on_an_edge))) {
    fail(&BatchAgreement::stray,
         fmt::format("sample {}, after a slide: theta {:.2g} count apart", a.k, difference));
  }
  if (differ) {
    result_.part = 1;
    return;
  }
  result_.theta_after = std::max(result_.theta_after, difference);
  result_.ratio_after = std::max(result_.ratio_after, difference / allowed());
}

/// Compares all measures of a move: they must be equal, except positions, which must agree to the accuracy of
/// θ, and the reversal depth, which has its own rule.
void Comparison::compare_move(std::size_t number, const trial::MoveOutcome& a, const trial::MoveOutcome& b) {
  std::string text;
  for (const layout::RecordField<trial::MoveOutcome>& field : fields_of_moves()) {
    const std::string& name = field.column.name;
    const double x = layout::value_of(field, a);
    const double y = layout::value_of(field, b);
    if (name == "reversal_depth" || x == y || (std::isnan(x) && std::isnan(y))) continue;
    const bool is_position = field.column.unit == "rad" || name.ends_with("true_error") ||
                             name == "step_motion" || name == "reversal_spike" ||
                             name.starts_with("rest_error") || name.starts_with("following_error");
    const double difference = std::abs(x - y) / (field.column.unit == "rad" ? resolution_ : 1.0);  // counts
    if (!is_position || !(difference < allowed())) text += fmt::format(" {} {} and {}", name, x, y);
    if (is_position && !slid_) result_.floating = std::max(result_.floating, difference);
  }
  if (!text.empty()) {
    fail(&BatchAgreement::other_measures, fmt::format("move {}:{}", number, text));
  } else if (a.reversal_depth != b.reversal_depth && result_.depth_by_steps == 0) {
    if (reversal_depth_changes_with_steps(parameters_)) {
      result_.depth_by_steps = 1;
      return;
    }
    result_.depth_apart = std::abs(a.reversal_depth - b.reversal_depth);
    fail(&BatchAgreement::other_depth,
         fmt::format("move {}: reversal_depth {} and {}", number, a.reversal_depth, b.reversal_depth));
  }
}

void Comparison::compare_jerks(std::int64_t moves, const std::vector<trial::Jerk>& jerks) {
  const auto of_moves = [moves](const std::vector<trial::Jerk>& all) {
    std::vector<trial::Jerk> some;
    std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                 [moves](const trial::Jerk& jerk) { return jerk.move < moves; });
    return some;
  };
  const auto same = [](const trial::Jerk& a, const trial::Jerk& b) {
    return a.move == b.move && a.onset == b.onset && a.duration == b.duration && a.magnitude == b.magnitude &&
           a.direction == b.direction;
  };
  const std::vector<trial::Jerk> a = of_moves(jerks);
  const std::vector<trial::Jerk> b = of_moves(batched_.jerks);
  if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) {
    fail(&BatchAgreement::other_measures, fmt::format("other jerks, {} and {}", a.size(), b.size()));
  }
}

void Comparison::take_outcome(const trial::TrialOutcome& outcome, const std::vector<trial::Jerk>& jerks) {
  const auto& moves = outcome.moves;
  const bool slides =
      std::any_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) { return move.broke_away; });
  result_.trials = 1;
  result_.in_lanes = batch::runs_in_lanes(parameters_);
  result_.slides = slides;
  if (static_cast<std::size_t>(taken_) < batched_.samples.size() && !slides && !settled()) {
    fail(&BatchAgreement::other_counts, fmt::format("more than {} samples", taken_));
  }
  if (settled()) return;
  if (moves.size() != batched_.outcome.moves.size()) {
    fail(&BatchAgreement::other_measures, fmt::format("{} moves", batched_.outcome.moves.size()));
    return;
  }
  std::int64_t end = 0;
  std::int64_t compared = 0;
  for (std::size_t m = 0; m < moves.size() && result_.other_measures + result_.other_depth == 0; ++m) {
    // What is measured of a move reaches to the sampling instant after it.
    end += trial::samples_of_move(parameters_, m);
    if (result_.part > 0 && (end >= before_slide_ || moves[m].broke_away)) break;
    compare_move(m, moves[m], batched_.outcome.moves[m]);
    ++compared;
  }
  if (result_.other_measures + result_.other_depth == 0) compare_jerks(compared, jerks);
}

}  // namespace

BatchAgreement compare_with_reference(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                                      const std::string& name) {
  Comparison comparison(parameters, batched, name);
  std::vector<trial::Jerk> jerks;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) { comparison.take(sample); };
  observers.jerk = [&](const trial::Jerk& jerk) { jerks.push_back(jerk); };
  comparison.take_outcome(trial::run_trial(parameters, observers), jerks);
  return comparison.result();
}

BatchAgreement agreement_of(const std::vector<trial::TrialParameters>& trials, const std::string& name,
                            const batch::BatchSettings& settings) {
  const std::vector<BatchedTrial> batched = run_batch(trials, settings);
  BatchAgreement agreement;
  for (std::size_t i = 0; i < trials.size(); ++i)
    agreement.add(compare_with_reference(trials[i], batched[i], fmt::format("{} {}", name, i)));
  return agreement;
}

void BatchAgreement::add(const BatchAgreement& other) {
  trials += other.trials;
  in_lanes += other.in_lanes;
  slides += other.slides;
  samples += other.samples;
  on_edge += other.on_edge;
  other_counts += other.other_counts;
  other_depth += other.other_depth;
  depth_by_steps += other.depth_by_steps;
  other_measures += other.other_measures;
  theta = std::max(theta, other.theta);
  floating = std::max(floating, other.floating);
  depth_apart = std::max(depth_apart, other.depth_apart);
  part += other.part;
  stray += other.stray;
  if (other.part == 0) {
    theta_after = std::max(theta_after, other.theta_after);
    ratio_after = std::max(ratio_after, other.ratio_after);
  }
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
}

std::string BatchAgreement::figures() const {
  return fmt::format(
      "{} trials, {} in lanes, {} slide; {} samples before a slide compared: theta within {:.1e} count, "
      "floating measures within {:.1e} count; other counts or codes {}, other reversal depth {} (by up to "
      "{}; and {} by "
      "the steps), other discrete measure {}, on an edge {}; of the sliding ones {} part, {} not on an "
      "edge, the others stay within {:.1e} count ({:.1e} of what is promised)",
      trials, in_lanes, slides, samples, theta, floating, other_counts, other_depth, depth_apart,
      depth_by_steps, other_measures, on_edge, part, stray, theta_after, ratio_after);
}

}  // namespace zerocount::testing

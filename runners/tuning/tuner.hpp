#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "analysis/goal/goal_verdict.hpp"
#include "analysis/tuning/search.hpp"
#include "experiments/study/study.hpp"
#include "runners/tuning/loop_examiner.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

struct TuneSettings {
  std::filesystem::path output;      ///< the results file of the proof
  std::int64_t max_trials{500'000};  ///< of the search
  std::optional<double> seconds{};   ///< of search and proof together; the search takes half of them
  int threads{0};
  bool quiet{false};
};

/// Trials of the tuned study on machines that the search never saw.
struct Proof {
  study::Study study;
  goal::Verdict verdict;               ///< its confidence allows for all attempts
  std::optional<goal::Needs> needs{};  ///< that would decide an undecided one
  int attempts{1};                     ///< candidates or sizes that were proven, this one included
};

/// Range of a free parameter, the others as tuned, in which the goal seems to be met.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
};

/// The best with some parameters fixed.
struct Alternative {
  std::vector<std::pair<std::string, double>> fixed;
  std::vector<std::pair<std::string, double>> gains;
  goal::BoundedProportion moves;  ///< on machines that the search for it never saw
  double criterion{0.0};
  goal::Status status{goal::Status::undecided};
};

/// Rate of the goal with a cause of failures switched off.
struct Limit {
  std::string cause;
  double rate{0.0};
};

/// The machine of the proof that does worst.
struct WorstMachine {
  std::int64_t rig{0};  ///< or the trial, where no trials share a rig
  double met{0.0};      ///< proportion of its moves that meet the goal
  std::vector<std::pair<std::string, double>> inputs;
};

enum class TuneStatus { met, unreachable, undecided };

/// What tuning found.
struct TuneAnswer {
  TuneStatus status{TuneStatus::undecided};
  std::vector<study::FreeParameter> free;
  Values gains;             ///< empty if no candidate keeps the margins
  Estimate estimate;        ///< of the search; the best of many, so too good
  SmallestMargins margins;  ///< of the gains
  bool blind{false};        ///< the loop has no transfer function: no margins
  std::optional<Proof> proof;
  double criterion{0.0};              ///< by the proof
  double late_limit{0.0};             ///< quantile Aim::moves of the criterion's values, by the proof
  std::optional<double> delay_lost;   ///< controller.delay from which on the goal seems to be lost
  double delay{0.0};                  ///< controller.delay of the tuned study
  std::vector<std::string> at_edges;  ///< free parameters at an end of their range, "controller.ki = 5000"
  std::vector<Room> room;
  std::vector<Alternative> alternatives;
  std::vector<Limit> limits;
  std::optional<double> wider_band_rate;  ///< of the goal with a band one count wider, where it is not met
  std::optional<WorstMachine> worst;
  std::int64_t points{0};  ///< of the search
  std::int64_t trials{0};  ///< of the search
  bool converged{false};
  double seconds{0.0};
};

/// @throws Failure: bad_input if the study cannot be tuned, interrupted
TuneAnswer tune(const study::Study& study, const TuneSettings& settings, const std::stop_token& stop);

/// Rates of the goal on the first units of the study, with each cause of failures switched off that the study
/// has, and with the best pair of them. The first entry is "none".
std::vector<Limit> limits_of(const study::Study& study, const Units& units, const std::stop_token& stop);

/// The units of a study that is given: its rigs, or its trials.
Units units_of(const study::Study& study);

/// The machine with the fewest moves that meet the goal; of equal ones the one with the largest criterion.
WorstMachine worst_machine(const study::Study& study, const Units& units, const std::stop_token& stop);

}  // namespace zerocount::tuning

#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// The machines among which the worst is sought.
enum class MachineRegion {
  box,    ///< each drawn quantity within its central 99.9 %; its corners may be machines that nobody builds
  likely  ///< of the box, those whose normal scores have Σ z² ≤ the 99.9 % quantile of χ², without
          ///< correlations
};

/// The worst machine of a region.
struct WorstInBox {
  std::int64_t rig{0};    ///< of the study, from which it has its profiles; 0 without rigs
  std::int64_t trial{0};  ///< its worst trial, of replay_of()
  std::int64_t moves{0};  ///< by which it is judged; the search has not used them
  double met{0.0};        ///< proportion of these moves that meet the goal
  std::vector<std::pair<std::string, double>> inputs;
  std::vector<double> quantiles;  ///< [machine input] (study::machine_inputs)
  study::Study searched;          ///< the study with the trials of the search
};

/// Searches the region for the machine with the fewest moves that meet the goal; of equal ones the one whose
/// moves have the larger score (measures::MoveScore::event, that of `rare` too). The search begins at the
/// corners, at points that fill the box, and at the worst rigs.
/// @param results of all units of the study
/// @throws trial::Interrupted; Failure (bad_input) if the study draws nothing that differs between machines
WorstInBox worst_in_box(const study::Study& study, const Units& units, std::span<const UnitResult> results,
                        MachineRegion region, const std::stop_token& stop);

/// The study of which `worst.trial` is a trial, with the values of the machine in the text of its manifest.
/// @throws Failure (bad_input) if a sweep or joint samples give one of them
study::Study replay_of(const WorstInBox& worst);

}  // namespace zerocount::tuning

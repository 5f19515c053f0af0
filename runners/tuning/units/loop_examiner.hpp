#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

/// What the machines of the margins differ in beyond what the study draws (study::LoopSpread).
namespace zerocount::tuning {

/// The loop that has the smallest of a margin.
struct CriticalLoop {
  std::string name;  ///< that of theory::TrialLoop: "before sliding", "while sliding, the load stands", …
  /// Of the contact before it slides, N m/rad; nothing where it has no spring.
  std::optional<double> stiffness{};
  /// Number of the draw that made the machine; nothing where the stiffness says all of it.
  std::optional<std::int64_t> machine{};
  std::int64_t condition{0};
};

/// The worst value of a margin, and the loop that has it, where there is a limit.
struct Smallest {
  double value{std::numeric_limits<double>::infinity()};
  std::optional<CriticalLoop> loop{};
};

/// The smallest margins of the loops of all examined machines; infinite where no loop has a limit.
struct SmallestMargins {
  bool stable{true};  ///< no loop is unstable over the hold
  Smallest gain{};    ///< dB
  Smallest phase{};   ///< degrees
  Smallest delay{
      max_delay};  ///< samples by which the delay may grow until a loop is unstable, at most max_delay
  Smallest sensitivity{0.0};                  ///< the largest |S|, S = 1/(1 + L)
  double crossover{0.0};                      ///< the highest frequency at which |L| = 1, Hz; 0 without one
  std::int64_t machines{0};                   ///< that were examined
  bool before_sliding{false};                 ///< loops before the machines slide are among them
  bool sliding{false};                        ///< loops of sliding machines are among them
  study::LoopSpread spread{};                 ///< by which the machines differ beyond what the study draws
  std::vector<SmallestMargins> conditions{};  ///< [condition] those under each; empty without conditions

  static constexpr double max_delay = 10.0;
};

/// Whether these are at least as large as wanted.
bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted);

/// A trial of a machine under a condition, and the range of stiffness there.
struct ExaminedMachine {
  std::int64_t trial;
  std::int64_t condition;
  /// Of its trial; nothing for one that stands for all that differ in stiffness.
  std::optional<std::int64_t> draw;
  study::LoopSpread spread;
  double softest;   ///< contact before it slides, N m/rad; only of a spring of k1 and k2
  double stiffest;  ///< N m/rad
};

/// What is examined of a machine: a trial of it, with the gains of a candidate.
struct Examination {
  trial::TrialParameters p;
  const ExaminedMachine& machine;
  bool slides;
};

/// Examines whether the linear loops of the machines keep margins under every condition: at every stiffness
/// of the contact before it slides, from k1 to k1 + k2 over the friction profile of the machine, or that of
/// its bristles; and while the machines slide, if they do or friction has no stiffness; each in every state
/// of a load (theory::load_states). Each machine stands for those that differ from it by the spread of the
/// margins.
class LoopExaminer {
 public:
  /// Machines that differ in the stiffness of their spring alone are examined as one with the stiffness of
  /// all; of others the first 100.
  /// @param study whose first draws are the machines; the friction must not depend on free parameters
  /// @param machines number of these draws
  LoopExaminer(const study::Study& study, std::int64_t machines);

  /// Whether the loops have no transfer function: a plugin. Then nothing is examined and all is kept.
  bool is_blind() const { return machines_.empty(); }

  /// Whether the machines that were critical so far keep the margins.
  /// @param slides whether machines of the candidate slide
  bool may_keep(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// How far the critical machines are from keeping the margins: 0 where they keep them; below 1 the largest
  /// part of a margin that is missing; from 1 on a loop is unstable, and the faster it grows the larger.
  double shortfall(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// Whether all machines keep them; one that does not counts as critical from now on.
  /// @throws trial::Interrupted
  bool keeps(const study::Study& candidate, const study::LoopMargins& margins, bool slides,
             const std::stop_token& stop = {});

  /// @throws trial::Interrupted
  SmallestMargins margins_of(const study::Study& candidate, bool slides,
                             const std::stop_token& stop = {}) const;

  /// The lowest frequency (Hz) from which on a mode of the load (theory::with_load_mode) leaves no loop of
  /// the critical machines unstable, to 5 %, and not below 1 Hz. Nothing where the study has a load behind a
  /// coupling, or where a mode at half the sample rate already makes a loop unstable.
  /// @throws trial::Interrupted
  std::optional<double> lowest_mode(const study::Study& candidate, bool slides,
                                    const std::stop_token& stop = {}) const;

 private:
  /// A machine at one of the corners of its spread (corners_of).
  struct Corner {
    std::size_t machine;
    std::size_t corner;
    bool operator==(const Corner&) const = default;
  };

  /// All corners of a machine that stands for all; of others, which differ in more, the likely worst.
  std::vector<Corner> examined_corners() const;
  Examination at(const Corner& corner, const study::Study& candidate, bool slides) const;

  /// Adds the likely worst corners of the machine, if they are not there.
  void add_critical(std::size_t machine);

  std::vector<ExaminedMachine> machines_;
  std::int64_t examined_{0};    ///< machines for which they stand, under each condition
  std::int64_t conditions_{0};  ///< 0: none
  std::vector<Corner> critical_;
};

}  // namespace zerocount::tuning

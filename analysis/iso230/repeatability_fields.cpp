#include <array>

#include "analysis/iso230/repeatability_columns.hpp"

namespace zerocount::iso230 {

std::span<const DeviationSource> deviation_sources() {
  static constexpr std::array<DeviationSource, 2> sources{
      {{"true", "rad", "from the true position", &TrialRepeatability::from_position},
       {"encoder", "count", "from the fine encoder", &TrialRepeatability::from_encoder}}};
  return sources;
}

std::span<const RepeatabilityField<AxisRepeatability>> axis_fields() {
  using A = AxisRepeatability;
  static constexpr std::array<RepeatabilityField<A>, 12> fields{{
      {"reversal", "B", "reversal value of the axis", &A::reversal},
      {"mean_reversal", "B̄", "mean reversal value of the axis", &A::mean_reversal},
      {"repeatability_positive", "R↑", "repeatability of the axis, positive approach",
       &A::repeatability_positive},
      {"repeatability_negative", "R↓", "repeatability of the axis, negative approach",
       &A::repeatability_negative},
      {"repeatability", "R", "bidirectional repeatability of the axis", &A::repeatability},
      {"systematic_positive", "E↑", "systematic deviation of the axis, positive approach",
       &A::systematic_positive},
      {"systematic_negative", "E↓", "systematic deviation of the axis, negative approach",
       &A::systematic_negative},
      {"systematic", "E", "bidirectional systematic deviation of the axis", &A::systematic},
      {"mean_bidirectional", "M", "range of the mean bidirectional deviations of the axis",
       &A::mean_bidirectional},
      {"accuracy_positive", "A↑", "accuracy of the axis, positive approach", &A::accuracy_positive},
      {"accuracy_negative", "A↓", "accuracy of the axis, negative approach", &A::accuracy_negative},
      {"accuracy", "A", "bidirectional accuracy of the axis", &A::accuracy},
  }};
  return fields;
}

std::span<const RepeatabilityField<TargetRepeatability>> target_fields() {
  using T = TargetRepeatability;
  static constexpr std::array<RepeatabilityField<T>, 9> fields{{
      {"mean_positive", "x̄↑", "mean deviation at the target, positive approach", &T::mean_positive},
      {"mean_negative", "x̄↓", "mean deviation at the target, negative approach", &T::mean_negative},
      {"mean", "x̄", "mean bidirectional deviation at the target", &T::mean},
      {"reversal", "B", "reversal value at the target", &T::reversal},
      {"uncertainty_positive", "s↑", "standard uncertainty at the target, positive approach",
       &T::uncertainty_positive},
      {"uncertainty_negative", "s↓", "standard uncertainty at the target, negative approach",
       &T::uncertainty_negative},
      {"repeatability_positive", "R↑", "repeatability at the target, positive approach",
       &T::repeatability_positive},
      {"repeatability_negative", "R↓", "repeatability at the target, negative approach",
       &T::repeatability_negative},
      {"repeatability", "R", "bidirectional repeatability at the target", &T::repeatability},
  }};
  return fields;
}

}  // namespace zerocount::iso230

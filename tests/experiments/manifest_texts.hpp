#pragma once

#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/test.hpp"

namespace zerocount {

/// The five keys that a manifest must have, on five lines, and `more` after them.
std::string minimal_manifest(const std::string& more = "");

/// A minimal manifest with this value of the key `command`, on the fifth line.
std::string manifest_commanding(const std::string& command, const std::string& more = "");

/// A manifest that uses the sections of the paper's experiments, distributions, a profile and a sweep.
std::string full_manifest();

/// A manifest that uses all further features of a closed loop, beyond those of full_manifest().
std::string extended_manifest();

/// The message with which the text is refused; empty if it is accepted. The text is named "m.yaml". Marks
/// «…» in the text are removed before; in the message they stand for their places (see with_marks()).
std::string refusal_of(const std::string& text, const std::vector<std::string>& overrides = {},
                       const sections::ExternalInputs& external = {});

/// The study that parse_study() makes of the manifest `text`, under the file name "m.yaml". Marks «…» in the
/// text are removed before; in the warnings they stand for their places.
study::Study study_of(const std::string& text, const std::vector<std::string>& overrides = {},
                      const sections::ExternalInputs& external = {});

/// Index of the input column with this name.
std::size_t column_of(const study::Study& study, const std::string& name);

/// The assumptions about encoder noise, delay and amplifier lag being absent that the study makes because the
/// manifest does not mention them.
std::vector<std::string_view> unstated_premises(const study::Study& study);

/// Whether a message has these faults, one per line. "«»: plant.inertai | inertia" is a line that begins with
/// "m.yaml:«»: plant.inertai: ", where «» is the only mark of the text, and has the word "inertia" behind it;
/// there may be several words. "«2»: …" is at the second of several marks, "4:9: …" in line 4 and column 9.
/// Another fault names its source, such as "--set trials=x: trials | number".
::testing::AssertionResult has_faults(const std::string& message, std::string_view faults);

/// Whether these warnings have these faults, one per warning, in the notation "line:column: path | word".
::testing::AssertionResult has_faults(const std::vector<std::string>& warnings, std::string_view faults);

}  // namespace zerocount

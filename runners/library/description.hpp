#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/randomness/random_variables.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/element.hpp"

/// JSON descriptions of a study for other languages. The library gives them through its C interface, and the
/// program gives them to a package that finds no library.
namespace zerocount::library {

/// Name that the type of a column has in NumPy, such as "float64".
std::string_view type_of(hdf5::Element element);

/// Reads the study of a manifest that is given as text.
/// @param source name of the manifest, for messages
/// @param folder folder to which paths in the manifest are relative
/// @param overrides "key=value" changes of the manifest
study::Study study_of_text(std::string text, std::string_view source, const std::filesystem::path& folder,
                           const std::vector<std::string>& overrides);

/// Reads the study of a results file, with the overrides with which its trials were run.
study::Study study_of_file(const std::filesystem::path& file);

/// Checks that a design point exists.
/// @throws Failure (bad_input) if the study has no such design point
void require_point(const study::Study& study, std::int64_t point);

/// Random variables of the trials at a design point.
/// @throws Failure (bad_input) if its trials run under several conditions
randomness::RandomVariables sampled_variables(const study::Study& study, std::int64_t point);

/// JSON description of a study, as the function zerocount_describe_study of the C interface gives it.
std::string description_of(const study::Study& study);

/// JSON description of the random variables of a design point, as zerocount_describe_variables of the C
/// interface gives it.
std::string variables_of(const study::Study& study, std::int64_t point);

/// Text of a manifest with overrides ("key=value") applied. The manifest is not checked.
/// @param source name of the manifest, for messages
std::string manifest_of(const std::string& text, std::string_view source,
                        const std::vector<std::string>& overrides);

/// Description that the words after `zerocount --describe` ask for: `study SOURCE FOLDER OVERRIDE…` or
/// `manifest SOURCE OVERRIDE…`, with the text of the manifest on standard input, or `file FILE`.
std::string described(std::span<const std::string> words);

}  // namespace zerocount::library

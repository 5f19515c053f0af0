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

/// What other languages know of a study, as JSON: the library gives it by its C interface, and the program to
/// a package that finds no library.
namespace zerocount::library {

/// The name that NumPy has for the type of a column.
std::string_view type_of(hdf5::Element element);

/// The study of a manifest's text. @param folder from which the files that it names are found
study::Study study_of_text(std::string text, std::string_view source, const std::filesystem::path& folder,
                           const std::vector<std::string>& overrides);

/// The study of a results file, as its trials were run.
study::Study study_of_file(const std::filesystem::path& file);

/// @throws Failure (bad_input) where the study has no such design point
void require_point(const study::Study& study, std::int64_t point);

/// The random variables of a design point.
/// @throws Failure (bad_input) where its trials are under several conditions
randomness::RandomVariables sampled_variables(const study::Study& study, std::int64_t point);

/// What is known of a study (see zerocount_describe_study).
std::string description_of(const study::Study& study);

/// Its random variables (see zerocount_describe_variables).
std::string variables_of(const study::Study& study, std::int64_t point);

/// A manifest with its overrides; it is not checked.
std::string manifest_of(const std::string& text, std::string_view source,
                        const std::vector<std::string>& overrides);

/// What the words after `zerocount --describe` ask for: `study SOURCE FOLDER OVERRIDE…` or `manifest SOURCE
/// OVERRIDE…`, whose text is the standard input, or `file FILE`.
std::string described(std::span<const std::string> words);

}  // namespace zerocount::library

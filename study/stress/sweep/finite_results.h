#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace canyon::study {

/// What in a CSV file is neither a finite number, nor a word, nor absent where may_be_absent() says so; `kind` is that
/// list's name of the file. "LINE: COLUMN ..."; empty if all is well.
std::string not_finite_in_csv(std::string_view text, std::string_view kind);

/// The same for JSON, by the path of the value: "runs[0].nlos_share is null".
std::string not_finite_in_json(const std::string& text, std::string_view kind);

/// What is not finite, or missing, in all files of a directory that `canyon run` has left: CSV, JSON, clouds, tapes and
/// the page. Begins with the file's name; empty if all is well.
std::string not_finite_in_results(const std::filesystem::path& directory);

}  // namespace canyon::study

#pragma once

#include <string>

namespace canyon::report {

class JsonFields;

/// The head of a page about one fidelity of a mission over seeds: whose it is, with `further` after it (" · ..."), a
/// title, and below it `lead`; all as HTML.
std::string study_header(const JsonFields& summary, const std::string& further, const std::string& title,
                         const std::string& lead);

}  // namespace canyon::report

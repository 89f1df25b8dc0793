#pragma once

#include <string>
#include <string_view>

namespace canyon {

/// A text as one line that a terminal shows as it is: control characters and bytes that are no UTF-8 become \xHH, a
/// word of more than 120 bytes (damage rather than a name) loses its middle, and so does a text of more than 1000
/// bytes. What messages quote from files goes through here; texts of our own come out unchanged.
std::string printable_text(std::string_view text);

/// The same without anything left out: for names of files.
std::string escaped_text(std::string_view text);

}  // namespace canyon

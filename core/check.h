#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace canyon {

/// Thrown when the program itself is wrong; the message carries the values. Never used for bad user input.
class ProgramError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void throw_failed_check(const char* condition, const char* file, int line, const std::string& values);

/// Streams all arguments into one string, for check messages.
template <class... Args>
std::string join_values(const Args&... args) {
  std::ostringstream out;
  out.precision(17);
  ((out << args), ...);
  return out.str();
}

/// Always on, also in release builds: CANYON_CHECK(rate > 0, "rate = ", rate).
#define CANYON_CHECK(condition, ...)                                                                    \
  do {                                                                                                  \
    if (!(condition))                                                                                   \
      ::canyon::throw_failed_check(#condition, __FILE__, __LINE__, ::canyon::join_values(__VA_ARGS__)); \
  } while (false)

}  // namespace canyon

#include "canyon/apps/line/invocation.h"

namespace canyon::apps {

namespace {

Invocation& current() {
  static Invocation only;
  return only;
}

/// As a POSIX shell reads it back.
std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@%+=:,./_-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

const Invocation& invocation() {
  return current();
}

void set_invocation(int argc, char** argv, const char* commit) {
  current() = {"canyon", commit};
  for (int i = 1; i < argc; ++i) current().command_line += " " + quoted(argv[i]);
}

}  // namespace canyon::apps
